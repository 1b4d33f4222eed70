"""A day in 3D as one HTML file with a time bar, made with viser (the extra `replay3d`); it loads nothing."""

from __future__ import annotations

import math
from collections.abc import Generator, Iterator
from contextlib import closing, contextmanager
from pathlib import Path
from typing import Any

from markupsafe import escape

from coopera.config.files import write_output
from coopera.core.errors import RunError
from coopera.core.household import AgentId
from coopera.core.naming import printable
from coopera.rundir.directory import RunDir
from coopera.simulation.bodies.robot import load_robot
from coopera.simulation.homes.scene import SceneObject
from coopera.simulation.people.weights import PARTS
from coopera.simulation.sight.cameras import ROBOT_FOV
from coopera.simulation.sight.stage import Stage
from coopera.simulation.ways.navigation import Navigator
from coopera.simulation.world import World
from coopera.web.replay3d import solids
from coopera.web.replay3d.film import Made
from coopera.web.replay3d.installed import need_viser
from coopera.web.replay3d.poses import CAMERA, FPS, GONE, Frame, Pose, Scenery, acts_of, frames_of
from coopera.web.replay3d.ways import Ways

_VIEW = (13, 133, 119)  # the colour of a robot's view
_SIGN = 2.05  # height in metres at which it is written what somebody does
_STILL = 0.6  # seconds between two acts


def write_page(run: RunDir, day: int, file: Path) -> Made:
    """Write a day of a run as a page.

    Raises:
        ConfigError: If viser is not installed or the file cannot be written.
        RunError: If there is no such day, or nothing was done on it.
    """
    viser = need_viser()
    with _server(viser) as server:
        page, moments, seconds = None, 0, 0.0
        with closing(_frames(run, day)) as frames:
            for scenery, frame in frames:
                page = page or _Page(server, scenery)
                page.show(frame)
                moments, seconds = moments + 1, seconds + frame.seconds
        if page is None:
            raise RunError(f"{run.root}: nothing was done on day {day} that could be shown.")
        html = page.html(f"{run.root.name}, day {day}")
    write_output(file, html)
    return Made(file, file.stat().st_size, moments, seconds)


def _frames(run: RunDir, day: int) -> Generator[tuple[Scenery, Frame]]:
    scenery = None
    with closing(acts_of(run, day)) as acts:
        try:
            for shown in acts:
                scenery = scenery or _scenery(run, shown.home, shown.record.person)
                *frames, end = frames_of(scenery, shown)
                for frame in [*frames, end._replace(seconds=_STILL)]:
                    yield scenery, frame
        finally:
            if scenery is not None:
                scenery.stage.close()


def _scenery(run: RunDir, home: World, person: str) -> Scenery:
    robots = {agent: load_robot(run.config.robot) for agent in home.robots}
    skin = solids.person_skin(run.people()[person])
    stage = Stage(home.layout, home.people, robots, None)
    return Scenery(
        home.layout, stage, robots, dict.fromkeys(home.people, skin), Ways(Navigator(home.layout), robots, FPS)
    )


@contextmanager
def _server(viser: Any) -> Iterator[Any]:
    """A server of viser's, which is what records; nobody but this process can reach it."""
    server = viser.ViserServer(host="127.0.0.1", port=0, verbose=False)
    try:
        yield server
    finally:
        server.stop()


class _Page:
    """The page as it is recorded: what was shown last, so that only what moves is shown again."""

    def __init__(self, server: Any, scenery: Scenery) -> None:
        self._server, self._scenery = server, scenery
        scene = server.scene
        scene.set_up_direction("+z")
        self._look(server)
        scene.add_mesh_trimesh("/home", solids.home_mesh(scenery.scene))
        self._nodes: dict[str, Any] = {}
        self._shown: dict[str, Pose] = {}
        self._signs: dict[AgentId, tuple[Any, str]] = {}
        for agent, skin in scenery.skins.items():
            for number, mesh in solids.person_parts(skin):
                self._nodes[f"{agent}/{PARTS[number]}"] = scene.add_mesh_trimesh(f"/{agent}/{PARTS[number]}", mesh)
        for agent, body in scenery.robots.items():
            for link, mesh in solids.robot_links(body).items():
                self._nodes[f"{agent}/{link}"] = scene.add_mesh_trimesh(f"/{agent}/link{link}", mesh)
            fov = math.radians(ROBOT_FOV)
            eye = scene.add_camera_frustum(f"/{agent}/view", fov, 4 / 3, scale=0.45, color=_VIEW, cast_shadow=False)
            self._nodes[f"{agent}/{CAMERA}"] = eye
        for thing in scenery.scene.movable:
            self._add_thing(thing)
        self._title = scene.add_label("/hour", "", position=self._corner())
        self._recorder: Any = None

    def _look(self, server: Any) -> None:
        """Light from above, and a first view of the whole home from the south, as on its plan."""
        b = self._scenery.scene.bounds
        middle, reach = ((b.x0 + b.x1) / 2, (b.y0 + b.y1) / 2), max(b.x1 - b.x0, b.y1 - b.y0)
        server.initial_camera.position = (middle[0], middle[1] - 0.9 * reach, 1.15 * reach)
        server.initial_camera.look_at = (middle[0], middle[1] - 0.02 * reach, 0.0)
        server.initial_camera.up = (0.0, 0.0, 1.0)
        server.initial_camera.fov = math.radians(38)
        server.scene.configure_environment_map("studio", environment_intensity=0.15)
        server.scene.configure_default_lights(cast_shadow=True)

    def _corner(self) -> tuple[float, float, float]:
        b = self._scenery.scene.bounds
        return b.x0, b.y1 + 0.3, solids.WALLS + 0.3

    def show(self, frame: Frame) -> None:
        """Show a moment, for as long as it lasts."""
        for name, pose in frame.poses.items():
            if name not in self._nodes and (thing := frame.made.get(name.removeprefix("things/"))):
                self._add_thing(thing)
            node = self._nodes.get(name)
            if node is None or self._shown.get(name) == pose:
                continue
            before = self._shown.get(name)
            self._shown[name] = pose
            if (pose == GONE) != (before == GONE):
                node.visible = pose != GONE
            if pose == GONE:
                continue
            if before is None or before.place != pose.place:
                node.position = pose.place
            if before is None or before.turn != pose.turn:
                node.wxyz = pose.turn
        self._say(frame)
        if self._recorder is None:
            self._recorder = self._server.get_scene_serializer()
        self._recorder.insert_sleep(frame.seconds)

    def _add_thing(self, thing: SceneObject) -> None:
        mesh = solids.thing_mesh(self._scenery.scene, thing)
        self._nodes[f"things/{thing.name}"] = self._server.scene.add_mesh_trimesh(f"/things/{thing.name}", mesh)

    def _say(self, frame: Frame) -> None:
        """Write the hour beside the home, and over each head what somebody does."""
        if self._title.text != printable(frame.hour):
            self._title.text = printable(frame.hour)
        for agent in (*self._scenery.skins, *self._scenery.robots):
            text = printable(frame.doing.get(agent, ""))
            sign, said = self._signs.get(agent, (None, ""))
            if sign is None:
                sign = self._server.scene.add_label(f"/signs/{agent}", text, anchor="bottom-center")
            elif text != said:
                sign.text = text
            self._signs[agent] = (sign, text)
            body = frame.poses.get(f"{agent}/{PARTS[0]}") or frame.poses.get(f"{agent}/-1")
            if body is not None:
                place = (body.place[0], body.place[1], _SIGN)
                if tuple(sign.position) != place:
                    sign.position = place

    def html(self, title: str) -> str:
        """The page."""
        made: str = self._recorder.as_html()
        return made.replace("<title>Viser</title>", f"<title>{escape(title)}</title>")
