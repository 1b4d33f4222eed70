"""What is measured on meshes, also on those that are drawn carelessly."""

from __future__ import annotations

import math

import numpy as np
import pytest

from coopera.simulation.homes import columns
from coopera.simulation.homes.glb import Mesh
from coopera.simulation.homes.measured import Measured
from coopera.simulation.homes.measuring import Use, measure
from tests.simulation.synthetic_habitat import Solid, bed, bookshelf, box, chair, desk, drawers, sofa, together


def mesh_of(solid: Solid, *, turned: float = 0.0, mirrored: bool = False) -> Mesh:
    corners, faces = solid
    cos, sin = math.cos(turned), math.sin(turned)
    corners = corners @ np.array([[cos, sin, 0], [-sin, cos, 0], [0, 0, 1]])
    low, high = corners.min(axis=0), corners.max(axis=0)
    corners = corners - np.array([*(low + high)[:2] / 2, low[2]])
    faces = faces[:, ::-1] if mirrored else faces
    return Mesh(corners, faces, np.full((len(faces), 3), np.nan))


def heights(found: Measured) -> list[float]:
    return sorted({round(level[0], 3) for level in found.surfaces})


def test_an_open_shelf_carries_things_and_a_drawer_holds_them() -> None:
    assert heights(measure(mesh_of(bookshelf()), Use())) == pytest.approx([0.09, 0.46, 0.83, 1.2, 1.55, 1.9])
    found = measure(mesh_of(drawers()), Use())
    assert heights(found) == pytest.approx([0.85])
    assert sorted(level[0] for level in found.inside) == pytest.approx([0.09, 0.355, 0.62])
    assert all(0.19 < level[5] < 0.26 for level in found.inside)


def test_a_mesh_whose_faces_look_inwards_is_measured_like_one_whose_faces_look_outwards() -> None:
    for solid in (desk(), bookshelf(), drawers()):
        inwards, outwards = measure(mesh_of(solid, mirrored=True), Use()), measure(mesh_of(solid), Use())
        assert heights(inwards) == heights(outwards)
        assert len(inwards.inside) == len(outwards.inside)


def test_boards_that_are_single_sheets_carry_things_whichever_side_they_show() -> None:
    def sheet(z: float, flipped: bool) -> Solid:
        faces = [(0, 1, 2), (0, 2, 3)]
        corners = [(-0.4, -0.15, z), (0.4, -0.15, z), (0.4, 0.15, z), (-0.4, 0.15, z)]
        return np.array(corners), np.array([face[::-1] for face in faces] if flipped else faces)

    shelf = together([sheet(0.0, False), sheet(0.4, True), sheet(0.8, False)])
    assert heights(measure(mesh_of(shelf), Use())) == pytest.approx([0.0, 0.4, 0.8])


def test_what_is_inside_of_something_solid_carries_nothing() -> None:
    buried = together([box((-0.5, 0.5), (-0.3, 0.3), (0, 0.7)), box((-0.2, 0.2), (-0.2, 0.2), (0.1, 0.3))])
    buried = together([buried, box((-0.3, 0.3), (-0.2, 0.2), (0.5, 0.6))])
    found = measure(mesh_of(buried), Use())
    assert heights(found) == pytest.approx([0.7])
    assert found.inside == []


def test_a_partition_parts_a_shelf() -> None:
    """A shelf that is open at the front and at the back, with a panel between."""
    boards = [box((-0.5, 0.5), (-0.4, 0.4), (z - 0.02, z)) for z in (0.1, 0.5, 0.9)]
    found = measure(mesh_of(together([*boards, box((-0.5, 0.5), (-0.005, 0.005), (0.0, 0.9))])), Use())
    low = [level for level in found.surfaces if level[0] < 0.8]
    assert len(low) == 4
    assert all(level[3] > 0 or level[4] < 0 for level in low)
    assert all(level[5] == pytest.approx(0.38) for level in low)


def test_gaps_between_slats_are_bridged() -> None:
    slats = [box((-0.5, 0.5), (y, y + 0.07), (0.4, 0.42)) for y in np.arange(-0.3, 0.25, 0.1)]
    (level,) = measure(mesh_of(together(slats)), Use()).surfaces
    assert level[4] - level[3] > 0.5


@pytest.mark.parametrize("turned", [0.0, math.pi / 2, math.pi, -math.pi / 2])
def test_who_sits_turns_the_back_to_the_back_however_the_mesh_is_turned(turned: float) -> None:
    for solid in (chair(), sofa()):
        found = measure(mesh_of(solid, turned=turned), Use(sits=True)).seat
        assert found is not None
        assert math.cos(found.turn - (math.pi / 2 + turned)) == pytest.approx(1.0)


@pytest.mark.parametrize("turned", [0.0, math.pi / 2, math.pi, -math.pi / 2])
def test_who_lies_has_the_head_at_the_headboard_and_under_it_the_mattress_pillows_or_not(turned: float) -> None:
    found = measure(mesh_of(bed(), turned=turned), Use(sits=True, lies=True)).lie
    assert found is not None
    assert found.z == pytest.approx(0.42, abs=0.02)
    assert math.cos(found.turn - (math.pi / 2 + turned)) == pytest.approx(1.0)
    assert math.hypot(found.x, found.y) < 0.1


def test_the_solid_parts_hold_all_of_the_mesh_and_leave_out_what_is_free() -> None:
    solids = np.array(measure(mesh_of(bookshelf()), Use()).solids)
    for x, y, z, filled in (
        (0.49, 0.0, 1.0, True),
        (0.0, 0.0, 0.82, True),
        (0.0, 0.05, 0.65, False),
        (0, -0.15, 1, True),
    ):
        inside = (solids[:, 0] <= x + 1e-2) & (x - 1e-2 <= solids[:, 2]) & (solids[:, 1] <= y + 1e-2)
        inside &= (y - 1e-2 <= solids[:, 3]) & (solids[:, 4] <= z + 1e-2) & (z - 1e-2 <= solids[:, 5])
        assert inside.any() == filled


def test_a_mesh_that_lies_over_itself_without_end_is_not_measured(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(columns, "_MOST_IN_ALL", 1000)
    with pytest.raises(ValueError, match="too often"):
        measure(mesh_of(desk()), Use())
