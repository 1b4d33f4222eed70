from __future__ import annotations

import json
import math
from itertools import combinations

import numpy as np
import pytest

from coopera.core.errors import ConfigError, SimulationError
from coopera.core.household import HandOver
from coopera.simulation import PersonAgent, RobotAgent, load_scene
from coopera.simulation.acts.plans import UnableError, Walk, discs
from coopera.simulation.acts.walking import _in_the_way
from coopera.simulation.sight.stage import Camera
from coopera.simulation.tools import world_tools
from coopera.simulation.world import World
from tests.simulation.flat import bring, flat, move, put

FOUR = [PersonAgent("ana"), PersonAgent("ben"), RobotAgent("tall", "fetch"), RobotAgent("low", "husky_panda")]


def give(thing: str, receiver: str) -> HandOver:
    return HandOver(object=thing, receiver=receiver)


@pytest.fixture(scope="module")
def shared():
    with World(flat(), agents=FOUR, frame_size=(64, 48)) as world:
        yield world


@pytest.fixture
def home(shared):
    shared.restore({})
    return shared


@pytest.fixture(scope="module")
def maple():
    with World(load_scene("maple"), agents=FOUR, frame_size=(64, 48)) as world:
        yield world


def assert_apart(world: World) -> None:
    for (one, a), (two, b) in combinations(world.state.agents.items(), 2):
        assert math.dist(a.place, b.place) >= 0.49, (one, two)
        assert math.dist(a.spot, b.spot) >= 0.49, (one, two)


def assert_each_thing_in_one_place(world: World) -> None:
    """What somebody holds is with them alone, and everything else lies where the home says."""
    held = [state.thing for state in world.state.agents.values() if state.thing and world.layout.object(state.thing)]
    assert len(held) == len(set(held))
    on = [thing for room in world.rooms for thing in world.things_on(room)]
    assert sorted(on) == [thing.name for thing in world.layout.movable]
    for name in held:
        holder = world.state.agents[world.state.holder(name)]
        assert world.state.thing(world.layout.object(name)).position[:2] == holder.place


def bodies_seen(world: World) -> set[str]:
    """Whose bodies a picture of the whole home from above shows, in the middle of the recorded deed."""
    recording, stage = world._recording, world._watcher.drawn
    shot = recording.shots[-1]
    stage.show(recording.state, shot.at(shot.deed))
    x0, y0, x1, y1 = world.layout.bounds
    middle = ((x0 + x1) / 2, (y0 + y1) / 2)
    above = Camera((middle[0], middle[1] - 0.1, 1.1 * max(x1 - x0, y1 - y0)), (*middle, 0.0))
    seen = set(np.unique(stage.picture(above, (480, 360))[1]).tolist())
    return {agent for agent, body in stage.bodies.items() if body in seen}


_MAPLE = load_scene("maple")
HOUR = [
    ("ana", move("sofa_1", "book", "sit and read", scene=_MAPLE), "tall"),
    ("ben", move("kitchen_counter_1", "sponge", "wipe the surface", scene=_MAPLE), "low"),
    ("tall", give("glasses", "ana"), None),
    ("low", give("towel", "ben"), None),
    ("tall", put("mug_1", "coffee_table_1", scene=_MAPLE), None),
    ("low", put("orange_1", "dining_table_1", scene=_MAPLE), None),
    ("ben", move("sofa_1", "cup", "sit and rest", scene=_MAPLE), "tall"),
    ("low", give("banana", "ana"), None),
    ("tall", give("cup", "ben"), None),
    ("ana", move("dining_table_1", "bowl", "eat a meal", scene=_MAPLE), "low"),
]


def test_two_people_and_two_robots_of_different_bodies_live_an_hour_in_one_home(maple, tmp_path) -> None:
    maple.restore({})
    assert_apart(maple)
    for number, (agent, act, watcher) in enumerate(HOUR):
        outcome = maple.perform(agent, act, record=True, watcher=watcher)
        assert outcome.ok, outcome.reason
        assert outcome.agent == agent
        assert_apart(maple)
        assert_each_thing_in_one_place(maple)
        assert bodies_seen(maple) == {"ana", "ben", "tall", "low"}
        if isinstance(act, HandOver):
            assert maple.state.box[maple.state.person(act.receiver).thing].text == act.object
            assert maple.state.robot(agent).thing is None
        if watcher is not None:
            assert maple._recording.robot == watcher
            assert maple.percept(np.random.default_rng(0)).room == maple.room_of(agent)
            assert len(maple.frames(2, tmp_path / str(number))) == 4
    assert maple.holds("performed(ana, eat a meal)")
    assert not maple.holds("performed(ben, eat a meal)")
    left = json.loads(json.dumps(maple.snapshot()))
    maple.restore({})
    for agent, act, watcher in HOUR:
        maple.perform(agent, act, record=True, watcher=watcher)
    assert maple.snapshot() == left


def test_pictures_show_the_person_who_acts_as_the_robot_that_watches_sees_them(home) -> None:
    for agent, watcher in (("ana", "low"), ("ben", "tall")):
        assert home.perform(
            agent, move("kitchen_counter_1", "sponge", "wipe the surface"), record=True, watcher=watcher
        )
        recording, stage = home._recording, home._watcher.drawn
        shot = recording.shots[-1]
        moment = shot.at(shot.deed)
        stage.show(recording.state, moment)
        _, mask = stage.picture(home._watcher._eyes(recording, moment), (64, 48))
        assert (mask == stage.bodies[agent]).mean() > 0.01
        assert home.percept(np.random.default_rng(0)).room == "kitchen"


def _random_act(world: World, agent: str, rng: np.random.Generator):
    fixed, movable = list(world.objects("fixed")), list(world.objects("movable"))
    if rng.random() < 0.5:
        return put(str(rng.choice(movable)), str(rng.choice(fixed)), scene=world.layout)
    if agent in world.robots:
        return give(str(rng.choice(["mug", "book"])), str(rng.choice(world.people)))
    return move(str(rng.choice(fixed)), "book", str(rng.choice(world.motions)), world.layout)


@pytest.mark.parametrize("seed", range(3))
def test_random_acts_of_four_leave_them_apart_and_nobody_walks_through_another(home, seed) -> None:
    rng, done = np.random.default_rng(seed), 0
    for _ in range(40):
        agent = str(rng.choice(list(home.state.agents)))
        act = _random_act(home, agent, rng)
        try:
            plan = home.plan(agent, act)
        except UnableError:
            assert not home.perform(agent, act).ok
            continue
        _assert_ways_free(home, plan, agent)
        done += home.perform(agent, act).ok
        assert_apart(home)
        assert_each_thing_in_one_place(home)
    assert done >= 30


def _assert_ways_free(home: World, plan, actor: str) -> None:
    """Each walks from where they are, and around all others; who is asked to step aside may slip past who asks."""
    spots = {agent: state.spot for agent, state in home.state.agents.items()}
    floor = {agent: discs(home.state, agent) for agent in spots}
    for step in plan.steps:
        if isinstance(step, Walk):
            assert step.points[0] == spots[step.agent]
            asks = {actor} if step.agent != actor else set()
            for other in floor.keys() - {step.agent} - asks:
                assert _in_the_way(step, floor[other]) is None, (step.agent, other)
            spots[step.agent] = step.points[-1]
            floor[step.agent] = [
                disc._replace(x=step.points[-1][0], y=step.points[-1][1]) for disc in floor[step.agent][:1]
            ]


def test_three_sit_beside_each_other_and_a_fourth_finds_no_seat_there() -> None:
    people = [PersonAgent("ana"), PersonAgent("ben"), PersonAgent("cleo"), PersonAgent("dana")]
    with World(flat(), agents=people) as world:
        for one in world.people[:3]:
            assert world.perform(one, move("sofa_1", "book", "sit and read")).ok
        assert [world.state.person(one).posture for one in world.people] == ["sit", "sit", "sit", "stand"]
        assert_apart(world)
        refused = world.perform("dana", move("sofa_1", "book", "sit and read"))
        assert refused.reason == "somebody sits at the sofa already."
        assert_apart(world)


def test_the_bed_of_one_is_not_the_bed_of_another() -> None:
    with World(flat(), agents=FOUR) as world:
        assert world.perform("ana", move("bed_1", "pillow", "take a nap")).ok
        refused = world.perform("ben", move("bed_1", "pillow", "take a nap"))
        assert refused.reason == "somebody is on the bed already."
        assert_apart(world)


def test_what_a_robot_holds_a_person_is_brought_and_other_robots_wait_for(home) -> None:
    assert home.pick("tall", "mug_1").ok
    refused = home.perform("low", put("mug_1", "dining_table_1"))
    assert refused.reason == "tall holds the mug; it can be had once it is put down."
    assert home.state.holder("mug_1") == "tall"
    assert home.pick("ben", "mug_1").ok
    assert home.state.holder("mug_1") == "ben"
    assert math.dist(home.state.robot("tall").spot, home.state.person("ben").place) <= 1.25
    assert_each_thing_in_one_place(home)
    assert home.pick("ana", "mug_1").reason == "ben holds the mug; it can be had once it is put down."


def test_two_hold_things_that_look_alike_and_both_are_drawn(home) -> None:
    home.perform("ana", move("sofa_1", "book", "sit and read"))
    home.perform("ben", move("bed_1", "book", "lie and read"), record=True, watcher="tall")
    recording, stage = home._recording, home._watcher.drawn
    stage.show(recording.state, recording.shots[-1].at(recording.shots[-1].deed))
    books = {home.state.person(one).thing for one in ("ana", "ben")}
    assert len(books) == 2
    assert books <= set(stage.home.bodies)


@pytest.mark.parametrize(
    ("act", "reason"),
    [
        (bring("mug"), "it is not said to whom; the people here are ana, ben."),
        (give("mug", "cleo"), "there is no person 'cleo'; the people here are ana, ben."),
        (give("mug", "low"), "there is no person 'low'; the people here are ana, ben."),
    ],
)
def test_a_hand_over_to_nobody_known_fails_with_its_reason(home, act, reason) -> None:
    before = home.snapshot()
    assert home.perform("tall", act).reason == reason
    assert home.snapshot() == before


def test_a_hand_over_says_its_receiver_only_where_it_has_one() -> None:
    assert bring("mug").model_dump() == {"kind": "hand_over", "object": "mug"}
    assert give("mug", "ana").describe() == "bring the mug to ana"
    assert HandOver.model_validate_json(give("mug", "ana").model_dump_json()) == give("mug", "ana")
    assert set(HandOver.model_json_schema()["properties"]) == {"kind", "object"}


@pytest.mark.parametrize(
    ("ask", "sentence"),
    [
        (lambda home: home.perform("cleo", bring("mug")), "There is no agent 'cleo' in this home; there are ana, ben"),
        (lambda home: home.pick("human", "mug_1"), "There is no agent 'human'"),
        (lambda home: home.room_of("robot"), "There is no agent 'robot'"),
        (lambda home: world_tools(home), "There is no agent 'robot'"),
        (
            lambda home: home.perform("ana", put("mug_1", "sofa_1"), record=True),
            "There is more than one robot in this home; name one of tall, low.",
        ),
        (
            lambda home: home.perform("ana", put("mug_1", "sofa_1"), record=True, watcher="ben"),
            "There is no robot 'ben' in this home; name one of tall, low.",
        ),
        (lambda home: home.holds("holding(human, mug)"), "the agent being ana or ben or tall or low"),
    ],
)
def test_an_unknown_agent_is_one_sentence(home, ask, sentence) -> None:
    with pytest.raises((SimulationError, ConfigError), match=sentence.replace("(", r"\(")):
        ask(home)


@pytest.mark.parametrize(
    ("agents", "sentence"),
    [
        ([], "needs at least one agent"),
        ([PersonAgent(), PersonAgent()], "'human' is used more than once"),
        ([PersonAgent("Ana B.")], "not 'Ana B.'"),
        ([RobotAgent("a", "tractor")], "there is no robot 'tractor'"),
    ],
)
def test_agents_that_cannot_live_in_a_home_are_refused_in_a_sentence(agents, sentence) -> None:
    with pytest.raises(ConfigError, match=sentence):
        World(flat(), agents=agents)


def test_a_home_of_people_alone_has_nobody_to_watch_them() -> None:
    with World(flat(), agents=[PersonAgent("ana")]) as world:
        assert world.perform("ana", move("sofa_1", "book", "sit and read")).ok
        with pytest.raises(SimulationError, match="There is no robot in this home."):
            world.perform("ana", put("mug_1", "sofa_1"), record=True)


def test_a_snapshot_of_before_agents_had_ids_is_read_where_the_one_person_and_the_one_robot_live(home) -> None:
    with World(flat()) as world:
        world.perform("robot", bring("mug"))
        now = world.snapshot()
        person, robot = ({k: v for k, v in now["agents"][who].items() if k != "kind"} for who in ("human", "robot"))
        person["thing"] = "mug"  # in those days a thing from the magic box was but a text
        old = {"version": 1, "scene": "flat", "person": person, "robot": robot, "moved": now["moved"]}
        world.restore({})
        world.restore(old)
        assert world.snapshot() == now
        with pytest.raises(
            SimulationError, match=r"of a home of human \(person\), robot \(robot\), but this is one of"
        ):
            home.restore(old)


def test_a_snapshot_keeps_the_order_in_which_agents_were_put_into_the_home(home) -> None:
    home.perform("tall", give("mug", "ben"))
    text = json.dumps(home.snapshot())
    home.restore(json.loads(json.dumps(home.snapshot(), sort_keys=True)))
    assert json.dumps(home.snapshot()) == text


def test_a_model_sees_the_others_by_their_ids_and_hands_over_to_one_of_them(home) -> None:
    tools = {tool.name: tool for tool in world_tools(home, "low")}
    seen = json.loads(tools["look_around"].invoke({}))
    assert {"you", "ana", "ben", "tall"} <= set(seen)
    assert "motion" in seen["ana"]
    assert "motion" not in seen["tall"]
    assert tools["hand_over"].invoke({"thing": "book", "person": "ben"}).startswith("ben has the book.")
    assert home.holding("ben", "book")
    assert "it is not said to whom" in tools["hand_over"].invoke({"thing": "book"})
