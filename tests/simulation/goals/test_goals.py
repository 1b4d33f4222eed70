from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from coopera.core.errors import ConfigError
from coopera.core.household import FreeMotion, HandOver, PickPlace
from coopera.simulation.goals.achieved import goal_of
from coopera.simulation.goals.files import goal_from, parse_goals, read_goals
from coopera.simulation.goals.judging import Met, holds, met
from coopera.simulation.goals.reading import DEEPEST, LONGEST, read_goal
from coopera.simulation.goals.tree import PREDICATES, And, Atom, Eventually, Not, Or, Then
from coopera.simulation.state.home_state import HomeState, PersonState, RobotState, ThingState
from tests.names import ROOT
from tests.simulation.flat import flat

MUG, APPLE, CLEAN = Atom("on", ("mug", "sofa")), Atom("on", ("apple", "sofa")), Atom("clean", ("mug",))


# The notation


@pytest.mark.parametrize(
    ("text", "goal"),
    [
        ("on(mug, sofa)", MUG),
        ("  on ( mug ,  sofa ) ", MUG),
        ("on(mug,sofa) and not clean(mug)", And((MUG, Not(CLEAN)))),
        ("on(mug, sofa) or on(apple, sofa) and clean(mug)", Or((MUG, And((APPLE, CLEAN))))),
        ("(on(mug, sofa) or on(apple, sofa)) and clean(mug)", And((Or((MUG, APPLE)), CLEAN))),
        ("not (on(mug, sofa) or clean(mug))", Not(Or((MUG, CLEAN)))),
        ("not not clean(mug)", Not(Not(CLEAN))),
        ("then(on(mug, sofa), not clean(mug) and on(apple, sofa))", Then((MUG, And((Not(CLEAN), APPLE))))),
        ("eventually(on(mug, sofa)) and clean(mug)", And((Eventually(MUG), CLEAN))),
        ("clean(every mug)", Atom("clean", ("mug",), every=True)),
        ("performed(sit and read)", Atom("performed", ("sit and read",))),
        ('filled(mug, "tea, with (hot) milk")', Atom("filled", ("mug", "tea, with (hot) milk"))),
        ('on("every ""good"" mug", sofa)', Atom("on", ('every "good" mug', "sofa"))),
    ],
)
def test_a_goal_is_read_from_text(text, goal) -> None:
    assert read_goal(text) == goal


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("on(mug, sofa", "at character 9 a word, and after it ',' or ')' was expected, not 'sofa'"),
        ("on(mug, sofa))", "at character 14 'and', 'or' or its end was expected, not ')'"),
        ("on(mug, sofa) clean(mug)", "'and', 'or' or its end was expected, not 'clean'"),
        ("on(mug, sofa) and", "was expected, and there it ends"),
        ("on(mug,, sofa)", "at character 8 a word"),
        ("then(on(mug, sofa))", "'then' joins two goals or more, not 1"),
        ("then(eventually(clean(mug)), clean(mug))", "eventually(clean(mug)) cannot stand in it"),
        ("eventually(then(clean(mug), clean(mug)))", "cannot stand in it"),
        ("evntually(clean(mug))", "did you mean eventually?"),
        ("__import__(os)", "a predicate was expected, not '__import__'"),
        ("not " * DEEPEST + "clean(mug)", f"more than {DEEPEST} deep"),
        ("(" * 900, f"more than {DEEPEST} deep"),
        ("clean(mug) and " * 200, f"{LONGEST} is the most"),
    ],
)
def test_what_is_no_goal_is_refused_in_a_sentence_that_says_what_was_expected(text, sentence) -> None:
    with pytest.raises(ConfigError) as refused:
        read_goal(text)
    assert sentence in str(refused.value)


words = st.text(min_size=1, max_size=12).filter(lambda word: word.strip())
now = st.recursive(
    st.builds(Atom, st.just("on"), st.tuples(words, words), st.booleans())
    | st.builds(Atom, st.just("performed"), st.tuples(words)),
    lambda goals: (
        st.builds(Not, goals)
        | st.builds(And, st.lists(goals, min_size=2, max_size=3).map(tuple))
        | st.builds(Or, st.lists(goals, min_size=2, max_size=3).map(tuple))
    ),
    max_leaves=5,
)
whole = now | st.builds(Eventually, now) | st.builds(Then, st.lists(now, min_size=2, max_size=3).map(tuple))


@given(whole, whole)
def test_a_goal_that_is_written_and_read_again_is_the_same(one, other) -> None:
    for goal in (one, And((one, Not(other))), Or((And((one, other)), other))):
        assert read_goal(str(goal)) == goal


@given(st.text(max_size=60) | st.text(alphabet="on(mug, sofa)\"'andnot ", max_size=60))
def test_any_text_is_a_goal_or_is_refused(text) -> None:
    try:
        goal = read_goal(text)
    except ConfigError:
        return
    assert read_goal(str(goal)) == goal


# YAML


def test_yaml_and_text_give_the_same_goals(tmp_path) -> None:
    path = tmp_path / "goals.yaml"
    path.write_text(
        """
goals:
  text: on(mug, sofa) and not clean(mug)
  mapping:
    all:
      - on(mug, sofa)
      - not: clean(mug)
  a list is all of it: [clean(mug), "on(mug, sofa)"]
  either: {any: ["on(mug, sofa)", "on(apple, sofa)"]}
  order:
    then: ["on(mug, sofa)", {not: clean(mug)}]
  once:
    eventually: {all: ["on(mug, sofa)", clean(mug)]}
  alone: [clean(mug)]
""",
        encoding="utf-8",
    )
    assert {name: str(goal) for name, goal in read_goals(path).items()} == {
        "text": "on(mug, sofa) and not clean(mug)",
        "mapping": "on(mug, sofa) and not clean(mug)",
        "a list is all of it": "clean(mug) and on(mug, sofa)",
        "either": "on(mug, sofa) or on(apple, sofa)",
        "order": "then(on(mug, sofa), not clean(mug))",
        "once": "eventually(on(mug, sofa) and clean(mug))",
        "alone": "clean(mug)",
    }


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("", "f.yaml must hold `goals:`"),
        ("goals: {}", "f.yaml must hold `goals:`"),
        ("goals: {a: clean(mug)}\nmore: 1", "f.yaml must hold `goals:`"),
        ("goals: {a: clean(mug), a: clean(mug)}", "'a' stands twice"),
        ("goals: {3: clean(mug)}", "a goal's name must be text, not 3"),
        ("goals: {a: 3}", "f.yaml, goals.a must be text, a list, or just one of `all:`"),
        ("goals: {a: {all: [], any: []}}", "f.yaml, goals.a must be text, a list, or just one of"),
        ("goals: {a: {all: []}}", "f.yaml, goals.a.all is empty"),
        ("goals: {a: {all: clean(mug)}}", "f.yaml, goals.a.all must be a list of goals"),
        ("goals: {a: {evenly: clean(mug)}}", "there is no 'evenly'"),
        ("goals: {a: {eventualy: clean(mug)}}", "did you mean eventually?"),
        ("goals: {a: {then: [clean(mug), {eventually: clean(mug)}]}}", "f.yaml, goals.a.then: "),
        ("goals: {a: {all: [clean(mug), {not: cleen(mug)}]}}", "f.yaml, goals.a.all.1.not: "),
        ("goals: {a: [on(mug, sofa)]}", "in a YAML list in [brackets] a goal with a comma stands in quotes"),
        ("goals: {a: &x clean(mug), b: *x}", "an alias"),
        ("goals: {a: !!python/object:os.system x}", "is not valid YAML"),
        ("goals: {a: " + "[" * 30 + "clean(mug)" + "]" * 30 + "}", f"at most {DEEPEST} deep"),
        ("[" * 5000, "nested more than 64 deep"),
        ("# " + "x" * 200_000, "200000 is the most"),
    ],
)
def test_yaml_that_holds_no_goals_is_refused_in_a_sentence(text, sentence) -> None:
    with pytest.raises(ConfigError) as refused:
        parse_goals(text, "f.yaml")
    assert sentence in str(refused.value)
    assert "\n" not in str(refused.value)


def test_a_file_that_is_not_there_is_one_sentence(tmp_path) -> None:
    with pytest.raises(ConfigError, match="there is no such file of goals"):
        read_goals(tmp_path / "none.yaml")


@pytest.mark.parametrize("data", [None, 3, True, {}, {"all": None}, {1: 2}, [None], [[]]])
def test_data_that_is_no_goal_is_refused(data) -> None:
    with pytest.raises(ConfigError, match="here"):
        goal_from(data, "here")


def test_the_page_explains_every_predicate() -> None:
    page = (ROOT / "docs" / "goals.md").read_text(encoding="utf-8")
    assert [name for name in PREDICATES if f"| `{name}(" not in page and f", `{name}(" not in page] == []


# A day


def day(*moments: str) -> list[HomeState]:
    """One state for each moment; it says what is on the sofa, and everything else lies on the bed."""
    agents = {"human": PersonState(spot=(2, 2), place=(2, 2)), "robot": RobotState(spot=(1, 2))}
    states = []
    for moment in moments:
        state = HomeState(scene="flat", agents=agents)
        for thing in ("mug_1", "apple_1", "book_1"):
            carrier = "sofa_1" if thing.split("_")[0] in moment.split() else "bed_1"
            state = state.with_thing(thing, ThingState(position=(2, 0.5, 0.5), yaw=0, on=carrier))
        states.append(state)
    return states


@pytest.mark.parametrize(
    ("goal", "moments", "came_out"),
    [
        # what is said of no moment is asked of the last one
        ("on(mug, sofa)", ["", "mug", "mug"], Met(True, 1)),
        ("on(mug, sofa)", ["", "mug", ""], Met(False, 1)),
        ("on(mug, sofa)", ["", "", ""], Met(False, None)),
        ("on(mug, sofa) and on(apple, sofa)", ["mug", "apple", "mug apple"], Met(True, 2)),
        ("not on(mug, sofa)", ["mug", "", ""], Met(True, 1)),
        # eventually: at some moment
        ("eventually(on(mug, sofa))", ["", "mug", ""], Met(True, 1)),
        ("eventually(on(mug, sofa) and on(apple, sofa))", ["mug", "apple"], Met(False, None)),
        ("eventually(on(mug, sofa)) and eventually(on(apple, sofa))", ["mug", "apple"], Met(True, 1)),
        ("not eventually(on(mug, sofa))", ["", "", "mug"], Met(False, 0)),
        ("eventually(on(mug, sofa)) or on(apple, sofa)", ["apple", ""], Met(False, 0)),
        # then: one after the other, or at the same moment
        ("then(on(mug, sofa), on(apple, sofa))", ["mug", "apple"], Met(True, 1)),
        ("then(on(mug, sofa), on(apple, sofa))", ["apple", "mug"], Met(False, None)),
        ("then(on(mug, sofa), on(apple, sofa))", ["", "mug apple"], Met(True, 1)),
        ("then(on(mug, sofa), not on(mug, sofa), on(mug, sofa))", ["mug", "", "", "mug"], Met(True, 3)),
        ("then(on(mug, sofa), not on(mug, sofa), on(mug, sofa))", ["mug", "mug", ""], Met(False, None)),
        ("then(on(mug, sofa), on(apple, sofa), on(book, sofa))", ["mug", "book", "apple", "book"], Met(True, 3)),
        # a day without acts
        ("not on(mug, sofa)", [], Met(False, None)),
    ],
)
def test_a_day_meets_a_goal_at_a_moment_or_does_not(goal, moments, came_out) -> None:
    assert met(read_goal(goal), flat(), day(*moments)) == came_out


def test_a_motion_is_performed_at_the_moments_whose_state_says_so() -> None:
    rest, nap = (state for state in day("", ""))
    rest = rest.with_agent("human", motion="sit and rest")
    nap = nap.with_agent("human", motion="take a nap")
    assert met(read_goal("then(performed(sit and rest), performed(take a nap))"), flat(), [rest, nap]) == Met(True, 1)
    assert not met(read_goal("then(performed(take a nap), performed(sit and rest))"), flat(), [rest, nap]).met
    alike = met(read_goal("eventually(performed(human, have a break))"), flat(), [nap, rest], lambda a, b: "rest" in b)
    assert alike == Met(True, 1)


def test_a_goal_about_a_day_is_not_asked_of_one_moment() -> None:
    (state,) = day("mug")
    assert holds(read_goal("on(mug, sofa)"), flat(), state)
    with pytest.raises(ConfigError, match=r"then\(.*\) is about a day, of which one moment says nothing; ask `met`"):
        holds(read_goal("not then(on(mug, sofa), on(mug, bed))"), flat(), state)


# What acts achieve


def test_an_act_achieves_a_goal() -> None:
    put = PickPlace(object_id=1, object="mug_1", receptacle_id=2, receptacle="desk_1")
    assert str(goal_of(put)) == "on(mug_1, desk_1)"
    within = put.model_copy(update={"relation": "inside", "receptacle": "dishwasher_1"})
    assert str(goal_of(within, lambda name: name.rsplit("_", 1)[0])) == "inside(mug, dishwasher)"
    assert str(goal_of(HandOver(object="tea"))) == "holding(person, tea)"
    assert str(goal_of(HandOver(object="tea", receiver="ana"))) == "holding(ana, tea)"
    read = FreeMotion(target_id=1, target="sofa_1", in_hand="book", motion="sit and read")
    assert str(goal_of(read)) == "performed(sit and read) and holding(person, book)"
