"""Tables in the paper's layout, as Markdown and as LaTeX."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from coopera.core.success import Counts
from coopera.evaluation import paper
from coopera.evaluation.analysis import (
    STATED,
    Cell,
    Endpoint,
    agreement,
    comparisons,
    control,
    curve,
    effort,
    generalisation,
    growth,
    last_day,
    late_days,
    noise_floors,
    plain,
    sampling_floors,
    score,
)
from coopera.evaluation.comparing import ALPHA, Comparison, people_needed
from coopera.evaluation.measuring import all_measures, find_measure
from coopera.evaluation.results import Row
from coopera.evaluation.statistics import FEWEST, INTERVAL
from coopera.evaluation.table import NONE, Table, cell, signed

REFERENCE = "ours"
PRIMARY = "help"
"""Need F1 is shown whatever the endpoint is."""
FRESH = "untrained"
_TYPES = {1: "type 1", 2: "type 2"}


def all_tables(rows: Sequence[Row], methods: Sequence[str], endpoint: Endpoint = STATED) -> list[Table]:
    """Every table that the rows allow, methods in the given order and the primary endpoint first."""
    every, rows = rows, plain(rows)
    tables = [
        late_table(rows, methods, endpoint),
        growth_table(rows, methods, endpoint),
        comparison_table(every, methods, endpoint),
        control_table(every, methods, endpoint),
        noise_table(every, methods, endpoint),
        need_table(rows, methods),
        *[last_day_table(rows, methods, measure) for measure in _measures(rows)],
        paper_table(rows, methods),
        comparison_table(rows, methods),
        order_table(rows),
        effort_table(rows, methods),
        generalisation_table(rows),
        agreement_table(rows, methods),
        activity_table(rows, methods),
    ]
    return [table for table in tables if table.rows]


def _measures(rows: Sequence[Row]) -> list[str]:
    """Every measure that some row has, those that count candidates first."""
    taken = [spec for spec in all_measures() if any(row.of(spec) is not None for row in rows)]
    counted = [spec.name for spec in taken if issubclass(spec.figures, Counts)]
    return [*counted, *(spec.name for spec in taken if spec.name not in counted)]


def last_day_table(rows: Sequence[Row], methods: Sequence[str], measure: str) -> Table:
    """A measure on each person's last day, by setting and type."""
    places = _places(rows)
    lines = _lines(methods, [last_day(_of(rows, place), measure) for place in places])
    spec = find_measure(measure)
    what = f"F1 by {measure}" if issubclass(spec.figures, Counts) else _upper(spec.title)
    return Table(
        f"last_day_{measure}",
        f"{what} on each person's last day",
        ["method", *map(_place, places)],
        lines,
        _MEANS,
    )


def late_table(rows: Sequence[Row], methods: Sequence[str], endpoint: Endpoint = STATED) -> Table:
    """The primary endpoint: its measure as the mean of each person's late days, by setting and type."""
    places = _places(rows)
    found = {place: late_days(_of(rows, place), endpoint.measure, endpoint) for place in places}
    return Table(
        "late_days",
        f"Primary endpoint: {endpoint.title}, mean of the late days",
        ["method", *map(_place, places)],
        _lines(methods, [found[place] for place in places]),
        f"{endpoint}. {_MEANS}",
    )


def growth_table(rows: Sequence[Row], methods: Sequence[str], endpoint: Endpoint = STATED) -> Table:
    """How much better the late days are than the early ones."""
    places = _places(rows)
    found = {place: growth(_of(rows, place), endpoint.measure, endpoint) for place in places}
    every = [found[place] for place in places]
    return Table(
        "growth",
        f"Growth of {endpoint.title} from the early to the late days",
        ["method", *map(_place, places)],
        _lines([method for method in methods if any(method in cells for cells in every)], every),
        f"{endpoint}. {_MEANS}",
    )


def need_table(rows: Sequence[Row], methods: Sequence[str]) -> Table:
    """Need precision, recall and F1 of all hours together."""
    lines = []
    for method in methods:
        hours = [row for row in rows if row.method == method]
        found = [score(hours, PRIMARY, name) for name in ("precision", "recall", "f1")]
        if any(value is not None for value in found):
            lines.append([method, *(NONE if value is None else f"{value:.3f}" for value in found)])
    return Table(
        "need",
        "Need precision, recall and F1, all days",
        ["method", "need precision", "need recall", "need F1"],
        lines,
        "Precision: share of the accepted acts that helped with a remaining task. Recall: share of the person's "
        "remaining tasks that were helped. Hours pooled; no intervals.",
    )


def paper_table(rows: Sequence[Row], methods: Sequence[str]) -> Table:
    """The paper's ablation table, ours beside theirs, both types together."""
    settings = sorted({row.setting for row in rows} & {"1", "2", "3", "4"})
    found = {setting: last_day([row for row in rows if row.setting == setting]) for setting in settings}
    lines: list[list[str]] = []
    for method in [name for name in (*paper.LAST_DAY, *methods) if settings and name in methods]:
        if method in [line[0] for line in lines]:
            continue
        cells = []
        for setting in settings:
            cell, theirs = found[setting].get(method), paper.LAST_DAY.get(method, {}).get(setting)
            cells += [f"{cell.interval.mean:.3f}" if cell else NONE, f"{theirs:.3f}" if theirs else NONE]
        lines.append([method, *cells])
    heads = [head for setting in settings for head in (f"S{setting}", f"S{setting} paper")]
    return Table(
        "paper",
        "Predicate success on the last day, mean of both types, beside the paper",
        ["method", *heads],
        lines,
        "The paper's baselines have no published numbers, only plots. Models differ, so levels are not comparable.",
    )


def comparison_table(rows: Sequence[Row], methods: Sequence[str], late: Endpoint | None = None) -> Table:
    """Each method against the reference on the same days, all settings and types together.

    With an endpoint its measure on its late days by its test, without one the paper's: predicate F1 on last days.
    """
    stated = late or _PAPERS
    found = comparisons(rows, stated.reference, stated.measure, late)
    family = [one for one in found if one.p_corrected is not None]
    floors = any(one.noise is not None for one in found)
    lines = [
        [
            one.method,
            signed(one.difference),
            f"{one.p:.4f}",
            NONE if one.p_corrected is None else f"{one.p_corrected:.4f}",
            str(one.people),
            *([_floor(one)] if floors else []),
            *([NONE if one.detectable is None else f"{one.detectable:.3f}"] if _testable(found) else []),
        ]
        for one in sorted(found, key=lambda one: (one.p_corrected is None, list(methods).index(one.method)))
    ]
    what = f"{late.title}, mean of the late days" if late else "predicate F1 on the same last days"
    times = len(family) if stated.correction == "holm" else 1
    notes = [
        f"{late}." if late else "The paper's endpoint.",
        f"Mean over people with a {INTERVAL}; {_TESTS[stated.test]} over people, two-sided.",
        *(
            [
                f"Its p stays below {ALPHA} after {_CORRECTIONS[stated.correction]} of {len(family)} comparisons from "
                f"{people_needed(max(times, 1))} people on."
            ]
            if stated.test == "sign_flip"
            else []
        ),
        *(["Rows without a corrected p were not among the stated comparisons."] if len(family) < len(found) else []),
        *([_FLOOR] if floors else []),
        *(["Detectable: the true difference found with 80 % power at this scatter."] if _testable(found) else []),
    ]
    corrected = "p (Holm)" if stated.correction == "holm" else "p (stated)"
    return Table(
        "comparisons_late" if late else "comparisons",
        f"Difference to {stated.reference} in {what}",
        [
            "method",
            "difference",
            "p",
            corrected,
            "people",
            *(["noise floor"] if floors else []),
            *(["detectable"] if _testable(found) else []),
        ],
        lines,
        " ".join(notes),
    )


_FLOOR = (
    "Noise floor: so large a difference can come from other seeds alone (with a single seed, from other samples of the "
    "models' replies); a smaller one is marked (below)."
)
_PAPERS = Endpoint(measure="predicate", late=1)
_TESTS = {"sign_flip": "sign-flip permutation test", "t": "t test"}
_CORRECTIONS = {"holm": "Holm's correction", "none": "no correction"}


def control_table(rows: Sequence[Row], methods: Sequence[str], endpoint: Endpoint = STATED) -> Table:
    """What a robot gains by reading the person's household file."""
    found = control(rows, endpoint)
    lines = [
        [method, cell(own), cell(shared), signed(compared.difference), f"{compared.p:.4f}"]
        for method, (own, shared, compared) in sorted(found.items(), key=lambda item: list(methods).index(item[0]))
    ]
    return Table(
        "control_shared",
        f"Control, {endpoint.title} in the late days: the robot's common sense its own, and shared with the person",
        ["method", "its own (as run)", "shared", "gain by sharing", "p"],
        lines,
        f"The same days, all settings and types together; p uncorrected. {_MEANS}",
    )


def noise_table(rows: Sequence[Row], methods: Sequence[str], endpoint: Endpoint = STATED) -> Table:
    """How much the endpoint moves with nothing changed but the seed, or but the models' samples."""
    kinds = {
        "other seeds": noise_floors(rows, endpoint),
        "same days, replies sampled anew": sampling_floors(rows, endpoint),
    }
    lines = [
        [method, kind, f"{found[method].sd:.3f} [{found[method].low:.3f}, {found[method].high:.3f}]",
         str(found[method].freedom), f"{found[method].floor:.3f}"]
        for kind, found in kinds.items()
        for method in methods
        if method in found
    ]  # fmt: skip
    return Table(
        "noise",
        f"Noise floor of {endpoint.title} in the late days",
        ["method", "nothing changed but", "SD of a person's episode", "degrees of freedom", "floor of the mean"],
        lines,
        "SD with its 95 % chi-square interval, of the same people in the same episodes. Floor: what the mean over all "
        "people and episodes moves by; 95 % of such repetitions stay within it.",
    )


def _floor(one: Comparison) -> str:
    if one.noise is None:
        return NONE
    return f"{one.noise.floor:.3f}{' (below)' if one.below_noise else ''}"


def _testable(found: Sequence[Comparison]) -> bool:
    """Whether any of the tests can find something."""
    return any(one.detectable is not None for one in found)


def order_table(rows: Sequence[Row]) -> Table:
    """Where the order of methods is the paper's."""
    lines = []
    for better, worse, where in paper.ORDER:
        pair = [row for row in rows if row.method in (better, worse)]
        for found in comparisons(pair, worse):
            agrees = "yes" if found.difference.mean > 0 else "no"
            sure = "" if found.p < 0.05 else " (not significant)"
            gap = signed(found.difference)
            lines.append([f"{better} > {worse}", where, gap, f"{found.p:.4f}", agrees + sure])
    return Table(
        "order",
        "The paper's order of methods, and ours",
        ["the paper says", "where", "our difference", "p", "agrees"],
        lines,
        "Predicate F1 on last days, all settings and types together; p uncorrected.",
    )


def effort_table(rows: Sequence[Row], methods: Sequence[str]) -> Table:
    """What the person got per hour."""
    found = effort(rows)
    lines = [[method, *(f"{value:.2f}" for value in found[method])] for method in methods if method in found]
    columns = ["method", "tasks helped", "metres saved", "false help"]
    return Table("effort", "Per hour: the person's effort saved, and false help", columns, lines, "All days.")


def generalisation_table(rows: Sequence[Row]) -> Table:
    """An unseen home and an unseen person."""
    lines = []
    for what, setting in (("scene", "2"), ("human", "3+1")):
        found = generalisation(rows, setting, REFERENCE, FRESH)
        if found:
            theirs = paper.GENERALISATION[what]
            lines.append([what, cell(found[0]), cell(found[1]), f"{theirs[0]:.3f}", f"{theirs[1]:.3f}"])
    return Table(
        "generalisation",
        "Generalisation: a fresh robot, and one that has learned elsewhere, on the same unseen day",
        ["unseen", "fresh", "learned", "paper: fresh", "paper: learned"],
        lines,
        "Scene: day 4 of setting 2, after four other homes. Human: a stranger after nine days with three others.",
    )


def agreement_table(rows: Sequence[Row], methods: Sequence[str]) -> Table:
    """L1 of predicate, judge and similarity to the person's own answers."""
    settings = sorted({row.setting for row in rows})
    lines = []
    for measure in ("predicate", "judge", "similar"):
        for method in methods:
            found = [agreement([r for r in rows if r.method == method and r.setting == s], measure) for s in settings]
            if any(value is not None for value in found):
                lines.append([f"{measure}, {method}", *(NONE if v is None else f"{v:.3f}" for v in found)])
        if measure not in paper.L1:
            continue
        theirs = [paper.L1[measure].get(setting) for setting in settings]
        lines.append([f"{measure}, paper (real people)", *(NONE if v is None else f"{v:.3f}" for v in theirs)])
    return Table(
        "agreement",
        "L1 between automatic success and the person's own evening answers, hour by hour",
        ["measure, method", *(f"S{setting}" for setting in settings)],
        lines,
        "Here the person is simulated; the paper's rows are of real people.",
    )


def activity_table(rows: Sequence[Row], methods: Sequence[str]) -> Table:
    """Predicate F1 by activity."""
    found = curve(rows, lambda row: row.activity)
    activities = sorted({str(name) for by in found.values() for name in by} - {""})
    hours = {name: sum(row.activity == name for row in rows if row.method == REFERENCE) for name in activities}
    lines = [
        [name, str(hours[name]), *(f"{found[m][name]:.3f}" if name in found.get(m, {}) else NONE for m in methods)]
        for name in sorted(activities, key=lambda name: -hours[name])
    ]
    columns = ["activity", "hours", *methods]
    return Table("activities", "Predicate F1 by activity, all days", columns, lines, "Hours pooled; no intervals.")


_MEANS = (
    f"Mean over people with a {INTERVAL}; several homes, episodes and seeds of a person are averaged first. "
    f"In parentheses how many episodes of a person these are; fewer than {FEWEST} people have no interval."
)


def _places(rows: Sequence[Row]) -> list[tuple[str, int]]:
    return sorted({(row.setting, row.collab) for row in rows})


def _of(rows: Sequence[Row], place: tuple[str, int]) -> list[Row]:
    return [row for row in rows if (row.setting, row.collab) == place]


def _place(place: tuple[str, int]) -> str:
    return f"S{place[0]} {_TYPES[place[1]]}"


def _lines(methods: Sequence[str], found: Sequence[Mapping[str, Cell]]) -> list[list[str]]:
    """A row per method, a cell per place; none where no place has any method."""
    lines = [[method, *(cell(cells.get(method)) for cells in found)] for method in methods]
    return lines if any(found) else []


def _upper(title: str) -> str:
    return title[:1].upper() + title[1:]
