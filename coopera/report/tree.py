"""Hours of a run as readable trees, drawn from the trace files alone."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping, Sequence

from rich.console import Console
from rich.markup import escape
from rich.tree import Tree

from coopera.core.clock import hour_label
from coopera.core.errors import ConfigError
from coopera.core.hour import Evening, HourRecord, HumanHour, ModelCall, Reasons, RobotHour, TaskCandidate
from coopera.core.household import Outcome
from coopera.core.people import TRAITS
from coopera.core.success import Counts
from coopera.evaluation.measuring import all_measures, told_in_the_evening
from coopera.report.console import PlainConsole
from coopera.report.progress import figure
from coopera.rundir.directory import RunDir
from coopera.rundir.trace_files import human_outcomes, intention_verdicts, read_json

_MARK = {True: "[green]yes[/]", False: "[red]no[/]", None: "[yellow]unread[/]"}
_RIGHT = {True: "[green]right[/]", False: "[red]wrong[/]", None: "[yellow]unscored[/]"}


def print_trees(run: RunDir, day: int | None, hour: int | None, console: Console | None = None) -> None:
    """Print the chosen hours, and the evening of each chosen day unless one hour was asked for.

    Raises:
        ConfigError: If the run has no such day or hour.
    """
    console = console or wide_console()
    for number in _days(run, day):
        evening = run.read_evening(number)
        for record in _chosen(run, number, hour):
            console.print(hour_tree(record, evening))
        if evening and hour is None:
            console.print(evening_tree(evening))


def print_json(run: RunDir, day: int | None, hour: int | None, console: Console | None = None) -> None:
    """Print one line of JSON: the one hour's file, or a list of the chosen files in order.

    Raises:
        ConfigError: If the run has no such day or hour.
    """
    console = console or wide_console()
    folder = run.root / "trace"
    files = [
        folder / f"day-{number:02d}" / f"hour-{record.hour:02d}.json"
        for number in _days(run, day)
        for record in _chosen(run, number, hour)
    ]
    if hour is None:
        files = [
            *files,
            *(path for number in _days(run, day) if (path := folder / f"day-{number:02d}" / "evening.json").is_file()),
        ]
        files.sort(key=lambda path: (path.parent.name, path.name == "evening.json", path.name))
    found = [read_json(path) for path in files]
    one = day is not None and hour is not None
    console.out(json.dumps(found[0] if one else found, sort_keys=True), highlight=False)


def wide_console() -> Console:
    """Standard output: wrapped on a terminal, uncut in a pipe."""
    console = PlainConsole(highlight=False)
    return console if console.is_terminal else PlainConsole(highlight=False, width=4000)


def hour_tree(record: HourRecord, evening: Evening | None = None) -> Tree:
    """One hour: the person, the robot, the success, the calls; the evening tells which intentions were right."""
    title = f"[bold]day {record.day}, {hour_label(record.hour)}[/] · {record.person} in {record.scene}"
    if record.episode_day != record.day:
        title += f" · episode {record.episode}, day {record.episode_day} of it"
    tree = Tree(title)
    if record.status == "failed":
        tree.add(f"[bold red]failed[/]: {escape(record.reason)}")
    if record.human:
        _add_human(tree.add("[bold]person[/]"), record.human)
    if record.robot:
        _add_robot(tree.add("[bold]robot[/]"), record.robot, intention_verdicts(evening, record.hour))
    _add_outcomes(tree, "what the person did", human_outcomes(record))
    [record] = told_in_the_evening([record], [evening] if evening else [])
    if record.success:
        branch = tree.add("[bold]success[/]")
        for spec in all_measures():
            if (found := spec.read(record.success)) is not None:
                said = _counts(found) if isinstance(found, Counts) else _flat(found.model_dump())
                branch.add(f"{spec.name:9} {said}")
    _add_calls(tree, record.calls)
    return tree


def evening_tree(evening: Evening) -> Tree:
    """One evening: what the person said, what the robot now believes, what was learned."""
    tree = Tree(f"[bold]day {evening.day}, evening[/] · {evening.person}")
    branch = tree.add(f"feedback ({len(evening.feedback)} answers)")
    for item in evening.feedback:
        said = "did" if item.accepted else "did not do"
        why = f" – {escape(item.reason)}" if item.reason else ""
        label = f"{hour_label(item.hour)}, {item.kind} [italic]{escape(item.text)}[/] (robot {said})"
        why += " [yellow](a slip: they meant the opposite)[/]" if item.slip else ""
        branch.add(f"{_MARK[item.helpful]} {label}{why}")
    belief = tree.add("the robot's belief about the person")
    belief.add(escape(evening.belief.profile or "no profile yet"))
    if evening.belief.big_five:
        scores = (f"{trait} {getattr(evening.belief.big_five, trait):.2f}" for trait in TRAITS)
        belief.add(", ".join(scores))
    for what, why in evening.traits_reasons.items():
        if why:
            belief.add(f"why ({escape(what)}): {escape(why)}")
    if evening.learned:
        learned = tree.add("learned")
        for name, measured in evening.learned.items():
            learned.add(escape(f"{name}: {_flat(measured)}"))
    _add_calls(tree, evening.calls)
    return tree


def _days(run: RunDir, day: int | None) -> list[int]:
    days = run.days()
    if day is None:
        return days
    if day not in days:
        there = f"days 0 to {days[-1]}" if days else "no day yet"
        raise ConfigError(f"--day: there is no day {day} in {run.root}; it has {there}.")
    return [day]


def _chosen(run: RunDir, day: int, hour: int | None) -> list[HourRecord]:
    records = run.read_day(day)
    if hour is None:
        return records
    chosen = [record for record in records if record.hour == hour]
    if not chosen:
        there = ", ".join(str(record.hour) for record in records) or "none"
        raise ConfigError(f"--hour: there is no hour {hour} on day {day} of {run.root}; its hours are {there}.")
    return chosen


def _add_human(tree: Tree, human: HumanHour) -> None:
    intention = human.intention
    mark = " (away from home)" if intention.away else " (goes on)" if intention.continues else ""
    _add_reasons(tree.add(f"intention: [bold cyan]{escape(intention.text)}[/]{mark}"), intention.reasons)
    for felt in human.circumstances:
        tree.add(f"these days: {escape(felt.text)} [dim]({felt.kind}, strength {felt.strength:.2f})[/]")
    if intention.away:
        return
    recalled = tree.add(f"recalled {len(human.recalled)}")
    for one in human.recalled:
        figures = f"{one.score:.3f} = recency {one.recency:.3f} x relevance {one.relevance:.3f}"
        recalled.add(f"{one.kind}: {escape(one.text)} [dim](score {figures})[/]")
    found = tree.add(f"found {len(human.found.fixed)} fixed, {len(human.found.movable)} movable objects")
    if intention.wants:
        found.add(escape("wanted: " + ", ".join(intention.wants)))
    found.add(escape("fixed: " + ", ".join(human.found.fixed)))
    found.add(escape("movable: " + ", ".join(human.found.movable)))
    if human.found.motions:
        found.add(escape("motions: " + ", ".join(human.found.motions)))
    tasks = tree.add("tasks")
    for task in human.tasks:
        branch = tasks.add(f"{task.id} [cyan]{escape(task.act.describe())}[/] – {escape(task.thought)}")
        _add_reasons(branch, task.reasons)
    _add_reflections(tree, human)


def _add_reflections(tree: Tree, human: HumanHour) -> None:
    for reflection in human.reflections:
        fine = sum(verdict.ok for verdict in reflection.verdicts)
        branch = tree.add(f"{reflection.node}: {fine} of {len(reflection.verdicts)} fine")
        for number, verdict in enumerate(reflection.verdicts, 1):
            if not verdict.ok or verdict.comment:
                branch.add(f"task {number} {'fine' if verdict.ok else 'not fine'}: {escape(verdict.comment)}")
        for change in reflection.changes:
            branch.add(f"[yellow]changed[/] {escape(change)}")
        for change in reflection.overruled:
            branch.add(f"[dim]overruled {escape(change)}[/]")
    for repair in human.repairs:
        tree.add(f"[yellow]mended by code[/] {escape(repair)}")


def _add_robot(tree: Tree, robot: RobotHour, verdicts: Mapping[str, bool | None]) -> None:
    seen = robot.observation
    what = seen.percept.caption() if seen.percept else "looks at the pictures itself"
    observed = tree.add(f"observed {len(seen.frames)} pictures: {escape(what)}")
    if seen.first_task:
        observed.add(escape(f"was told the first task: {seen.first_task}"))
    if robot.seen:
        observed.add(escape(f"said it saw: {robot.seen}"))
    for one in robot.recalled:
        source = f"{one.source} " if one.source else ""
        observed.add(f"recalled {source}{one.kind}: {escape(one.text)} [dim](score {one.score:.3f})[/]")
    for candidate in robot.intentions:
        said = _verdict(candidate.probability, candidate.accepted)
        right = _RIGHT[verdicts[candidate.text]] if candidate.text in verdicts else ""
        branch = tree.add(f"{said} intention [cyan]{escape(candidate.text)}[/] {right}")
        _add_reasons(branch, candidate.reasons)
        _add_tasks(branch, [task for task in robot.tasks if task.intention == candidate.text])
    known = {candidate.text for candidate in robot.intentions}
    _add_tasks(tree, [task for task in robot.tasks if task.intention not in known])
    for fallback in robot.fallbacks:
        tree.add(f"[yellow]fallback[/] {escape(fallback)}")
    _add_outcomes(tree, "outcomes", robot.outcomes)


def _add_tasks(tree: Tree, tasks: Sequence[TaskCandidate]) -> None:
    for task in tasks:
        said = _verdict(task.probability, task.accepted)
        words = f"task [cyan]{escape(task.act.describe())}[/] {_RIGHT[task.correct]}"
        tree.add(f"{said} {words} – {escape(task.thought)}")


def _add_reasons(tree: Tree, why: Reasons) -> None:
    for line in reasons(why):
        tree.add(escape(line))


def _add_outcomes(tree: Tree, title: str, outcomes: Sequence[Outcome]) -> None:
    if not outcomes:
        return
    branch = tree.add(title)
    for one in outcomes:
        ended = "[green]done[/]" if one.ok else f"[red]not done[/] ({escape(one.reason)})"
        branch.add(f"{escape(one.act.describe())}: {ended}, {one.metres:.1f} m{escape(_took(one))}")


def _took(outcome: Outcome) -> str:
    """What an act took besides the way: the motion that stood for the words, what was fetched and what was opened."""
    said = []
    if outcome.motion is not None and outcome.asked:
        near = "" if outcome.cosine is None else f" (cosine {outcome.cosine:.2f} with {outcome.asked!r})"
        said.append(f"as {outcome.motion}{', which is neutral: no motion comes near' if outcome.neutral else ''}{near}")
    said += [f"fetched {', '.join(outcome.fetched)}"] if outcome.fetched else []
    said += [f"opened {', '.join(outcome.opened)}"] if outcome.opened else []
    return "".join(f"; {one}" for one in said)


def _add_calls(tree: Tree, calls: Sequence[ModelCall]) -> None:
    if not calls:
        return
    seconds, tokens = sum(call.seconds for call in calls), sum(call.tokens_in + call.tokens_out for call in calls)
    branch = tree.add(f"calls: {len(calls)}, {seconds:.2f} s, {tokens} tokens")
    for call in calls:
        notes = [f"{call.seconds:.2f} s", f"{call.tokens_in} + {call.tokens_out} tokens"]
        notes += ["from the cache"] if call.cached else []
        notes += [f"{call.attempts} attempts"] if call.attempts > 1 else []
        leaf = branch.add(f"{escape(call.node)}: {escape(call.prompt)} · {escape(call.model)} · {', '.join(notes)}")
        if call.leniencies:
            mended = ", ".join(f"{kind} ({count})" for kind, count in call.leniencies.items())
            leaf.add(f"[dim]put right[/] {mended}")
        for fault in call.faults:
            leaf.add(f"[red]fault[/] {escape(fault)}")


def reasons(why: Reasons) -> Iterator[str]:
    """The reasons that were given, each led by what it rests on."""
    names = {"human": "who they are", "intentions": "earlier intentions", "tasks": "earlier tasks", "vision": "seen"}
    for field, name in names.items():
        if text := getattr(why, field):
            yield f"{name}: {text}"


def _verdict(probability: float | None, accepted: bool | None) -> str:
    """What the classifier said, such as "yes 0.73"."""
    said = "[green]yes[/]" if accepted else "[dim]no [/]" if accepted is not None else "  –"
    return f"{said} {'    –' if probability is None else f'{probability:.3f}'}"


def _counts(counts: Counts) -> str:
    rates = f"F1 {figure(counts.f1)}, precision {figure(counts.precision)}, recall {figure(counts.recall)}"
    return f"{rates} (tp {counts.tp}, fp {counts.fp}, fn {counts.fn}, tn {counts.tn}, unscored {counts.unscored})"


def _flat(value: object) -> str:
    if isinstance(value, dict):
        return ", ".join(f"{name} {_flat(one)}" for name, one in value.items())
    return f"{value:.3f}" if isinstance(value, float) else str(value)
