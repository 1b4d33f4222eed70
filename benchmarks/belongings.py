"""Where do people want things to be? `python -m benchmarks.belongings RANKS.csv > models/offline/human/belongings.csv`.

RANKS.csv is Housekeep's table (github.com/yashkant/housekeep, MIT): ten people's ranks of each room's places for 269
objects, above 0 for a right place, below 0 for a wrong one, 0 for an implausible one. `KIN` says which of these objects
are such a thing as ours, `PLACES` which of their furniture is such a one as ours, room by room. For each pair of ours
in which the thing fits, the output has the weight that people give it: 1 / rank of a right place, meant over people,
objects and rooms. Columns: thing, place, weight.

`--agreement` prints instead how often two people want the same thing at the same place: Housekeep's people by their own
furniture and by ours, room by room, and so many offline people (`--people`) in each of coopera's homes.
"""

from __future__ import annotations

import argparse
import csv
import sys
from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import combinations
from pathlib import Path
from typing import Any

import yaml

from coopera.core.people import BigFive
from coopera.memory import bundled
from coopera.models.offline.household.knowledge import shipped
from coopera.models.offline.household.reading import Surroundings
from coopera.models.offline.household.sense import CommonSense
from coopera.models.offline.human.belongings import of_use
from coopera.models.offline.human.person import PrivateLife

ROOT = Path(__file__).parents[1]
HOMES = ("maple", "oak", "pine", "rowan", "willow")
RIGHT = 0.2  # share of the people who must call a place right for such a thing
PEOPLE = [f"person_{number}" for number in range(10)]
KIN: dict[str, Sequence[str]] = {
    "alarm_clock": ["clock"],
    "apple": ["apple"],
    "banana": ["banana"],
    "blanket": ["cushion", "pillow"],
    "bleach_bottle": ["bleach_cleanser"],
    "board_game": ["board_game"],
    "book": ["book"],
    "bowl": ["bowl"],
    "broom": ["dustpan_and_brush"],
    "camera": ["camera", "instant_camera"],
    "candle": ["candle_holder"],
    "chips_can": ["fruit_snack", "snack_cake"],
    "coffee_can": ["master_chef_can", "coffee_beans"],
    "cooking_pot": ["dutch_oven", "pressure_cooker"],
    "cracker_box": ["cracker_box"],
    "cushion": ["cushion", "pillow"],
    "cutting_board": ["chopping_board"],
    "dumbbell": ["dumbbell"],
    "feather_duster": ["dustpan_and_brush"],
    "frying_pan": ["skillet", "saute_pan", "pan"],
    "game_controller": ["nintendo_switch", "video_game"],
    "gelatin_box": ["gelatin_box"],
    "glass": ["tumbler", "cup"],
    "guitar": ["guitar"],
    "hairbrush": ["hair_straightener", "hair_dryer"],
    "handbag": ["handbag"],
    "hat": ["hat"],
    "headphones": ["headphones"],
    "kettle": ["teapot"],
    "kitchen_knife": ["knife"],
    "laptop": ["laptop"],
    "laundry_basket": ["laundry_box"],
    "lemon": ["lemon"],
    "magazine": ["book", "weight_loss_guide"],
    "mug": ["mug", "cup"],
    "mustard_bottle": ["mustard_bottle"],
    "notebook": ["book", "folder"],
    "orange": ["orange"],
    "paint_box": ["paint_bottle_set", "fingerpaint"],
    "pen": ["large_marker", "crayon"],
    "pet_bowl": ["dog_bowl"],
    "pet_toy": ["dog_chew_toy"],
    "phone": ["tablet", "phone_stand"],
    "picture_frame": ["picture_frame"],
    "plate": ["plate"],
    "potted_meat_can": ["potted_meat_can"],
    "potted_plant": ["plant", "balancing_cactus"],
    "pudding_box": ["pudding_box"],
    "puzzle_box": ["puzzle_game"],
    "radio": ["portable_speaker"],
    "remote_control": ["remote_control"],
    "scarf": ["hat", "gloves"],
    "scissors": ["scissors"],
    "shoes": ["shoe"],
    "sketchbook": ["book", "folder"],
    "soap_dispenser": ["soap_dispenser"],
    "spatula": ["spatula"],
    "sponge": ["sponge"],
    "spoon": ["spoon", "fork"],
    "sugar_box": ["sugar_box"],
    "tablet": ["tablet"],
    "teapot": ["teapot"],
    "teddy_bear": ["stuffed_toy"],
    "tennis_ball": ["tennis_ball"],
    "tomato_soup_can": ["tomato_soup_can"],
    "toolbox": ["hammer", "power_drill"],
    "toothbrush": ["electric_toothbrush", "toothbrush_pack"],
    "towel": ["towel", "bath_sheet", "washcloth"],
    "toy_car": ["toy_vehicle"],
    "trash_can": ["waste_basket"],
    "tray": ["tray"],
    "tuna_can": ["herring_fillets"],
    "vase": ["vase"],
    "water_bottle": ["water_bottle"],
    "watering_can": ["pitcher_base", "plant_container"],
    "wine_bottle": ["sparkling_water"],
}
"""Our things, and the objects of Housekeep that are like them; things without are not in the table."""
_SEATS = {"sofa": "sofa", "sofa_chair": "armchair", "office_chair": "office_chair", "stool": "stool", "carpet": "rug"}
_BEDROOM = {**_SEATS, "bed": "bed", "chest": "dresser", "bottom_cabinet": "wardrobe", "top_cabinet": "wardrobe"}
_BEDROOM |= {"table": "nightstand", "coffee_table": "side_table", "console_table": "desk", "shelf": "bookshelf"}
_STORAGE = {"shelf": "storage_shelf", "table": "workbench", "counter": "workbench", "bottom_cabinet": "storage_shelf"}
_STORAGE |= {"washer": "washing_machine", "top_cabinet": "storage_shelf", "carpet": "rug"}
PLACES: dict[str, Mapping[str, str]] = {
    "bathroom": {
        **dict.fromkeys(("top_cabinet", "bottom_cabinet", "shelf"), "bathroom_cabinet"),
        **{"sink": "washbasin", "counter": "washbasin", "bathtub": "bathtub", "toilet": "toilet", "carpet": "rug"},
    },
    "bedroom": _BEDROOM,
    "childs_room": _BEDROOM,
    "closet": {"shelf": "wardrobe", "bottom_cabinet": "wardrobe"},
    "corridor": {"chair": "bench", "shelf": "shoe_rack", "table": "side_table", "carpet": "rug"},
    "dining_room": {
        **_SEATS,
        **{"table": "dining_table", "chair": "dining_chair", "bottom_cabinet": "kitchen_cabinet"},
        **{"console_table": "side_table", "counter": "kitchen_counter"},
    },
    "garage": _STORAGE,
    "home_office": {
        **_SEATS,
        "table": "desk",
        "counter": "desk",
        "shelf": "bookshelf",
        "bottom_cabinet": "storage_shelf",
    },
    "kitchen": {
        **dict.fromkeys(("top_cabinet", "bottom_cabinet", "shelf"), "kitchen_cabinet"),
        **dict.fromkeys(("stove", "cooktop"), "stove"),
        **{"counter": "kitchen_counter", "sink": "kitchen_sink", "table": "dining_table", "chair": "dining_chair"},
        **{name: name for name in ("fridge", "dishwasher", "microwave", "coffee_machine")},
    },
    "living_room": {
        **_SEATS,
        **{"coffee_table": "coffee_table", "table": "side_table", "console_table": "tv_stand", "shelf": "bookshelf"},
    },
    "lobby": {**_SEATS, "chair": "bench", "table": "side_table", "piano": "piano", "bottom_cabinet": "shoe_rack"},
    "playroom": {**_SEATS, "piano": "piano", "shelf": "bookshelf", "table": "desk"},
    "storage_room": _STORAGE,
    "television_room": {**_SEATS, "coffee_table": "coffee_table", "shelf": "bookshelf", "bottom_cabinet": "tv_stand"},
    "utility_room": _STORAGE,
}
"""Housekeep's rooms: their furniture, and ours that is like it there; what is not here is like none of ours."""

Row = Mapping[str, str]


def rooms_of(ranks: Path) -> dict[tuple[str, str], list[Row]]:
    """The places of each object in each room."""
    found: dict[tuple[str, str], list[Row]] = defaultdict(list)
    with ranks.open(newline="", encoding="utf-8") as file:
        for row in csv.DictReader(file):
            found[row["object"], row["room"]].append(row)
    return found


def weights(rooms: Mapping[tuple[str, str], Sequence[Row]]) -> Iterator[tuple[str, str, float]]:
    """Yield thing, place and weight of each pair of ours that people call right and in which the thing fits.

    Not of furniture at which things are used, such as a stove: what is put there is no matter of order.
    """
    catalogue = yaml.safe_load((ROOT / "simulation/homes/catalogue.yaml").read_text(encoding="utf-8"))
    for thing, kin in sorted(KIN.items()):
        said: dict[str, list[tuple[float, float]]] = defaultdict(list)
        for rows, ours in ((rooms[other, room], ours) for other in kin for room, ours in PLACES.items()):
            here: dict[str, list[Row]] = defaultdict(list)
            for row in rows:
                here[ours.get(row["receptacle"], "")].append(row)
            for place, alike in here.items():
                ranks = [[int(row[person]) for row in alike if int(row[person]) > 0] for person in PEOPLE]
                weight = sum(1 / rank for found in ranks for rank in found)
                said[place].append((weight / len(PEOPLE), sum(map(bool, ranks)) / len(PEOPLE)))
        for place, found in sorted(said.items()):
            weight, right = (sum(part) / len(found) for part in zip(*found, strict=True))
            if place and right >= RIGHT and not of_use(place) and _fits(catalogue, thing, place):
                yield thing, place, round(weight, 3)


def _fits(catalogue: Mapping[str, Any], thing: str, place: str) -> bool:
    """Whether a thing has room on top of a piece of furniture, inside of it, or stands there in our homes."""
    (width, depth, height), kind = catalogue["movable"][thing]["size"], catalogue["fixed"][place]
    for _, x0, x1, y0, y1, clear in kind["surfaces"]:
        room = sorted(((x1 - x0) * kind["size"][0], (y1 - y0) * kind["size"][1]))
        if min(width, depth) <= room[0] and max(width, depth) <= room[1] and height <= clear:
            return True
    return place in catalogue["movable"][thing]["put"]


def firsts(rooms: Mapping[tuple[str, str], Sequence[Row]], *, ours: bool) -> Iterator[list[str | None]]:
    """Yield the first place of each of Housekeep's people, for each object and room: in their words or in ours."""
    for (_, room), rows in rooms.items():
        names = PLACES.get(room, {}) if ours else {row["receptacle"]: row["receptacle"] for row in rows}
        first: list[str | None] = []
        for person in PEOPLE:
            right = [(int(row[person]), names[row["receptacle"]]) for row in rows if row["receptacle"] in names]
            first.append(min((one for one in right if one[0] > 0), default=(0, None))[1])
        yield first


def wished(people: int) -> Iterator[list[str | None]]:
    """Yield where offline people want each thing of each activity in each home, without what is only put to use."""
    sense = CommonSense(shipped(), bundled())
    lives = [PrivateLife(sense, f"I am person number {number}.", BigFive()) for number in range(people)]
    for home in HOMES:
        scene = yaml.safe_load((ROOT / f"simulation/scenes/{home}.json").read_text(encoding="utf-8"))
        fixed = Surroundings({one["name"]: (one["id"], one["room"]) for one in scene["objects"] if one["fixed"]})
        for activity in shipped().activities:
            theirs = [life.at_home(activity, fixed).places for life in lives]
            for number, (_, usual) in enumerate(activity.places):
                if fixed.of(usual) and not of_use(usual):
                    yield [places[number][1] for places in theirs]


def agreement(choices: Iterable[Sequence[str | None]]) -> tuple[float, int]:
    """Share of pairs of people who chose the same, among those who both chose; and the number of pairs."""
    pairs = [a == b for chosen in choices for a, b in combinations(filter(None, chosen), 2)]
    return sum(pairs) / len(pairs), len(pairs)


def main() -> None:
    """Print the table, or how often people agree."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("ranks", type=Path)
    parser.add_argument("--agreement", action="store_true")
    parser.add_argument("--people", type=int, default=20)
    args = parser.parse_args()
    rooms = rooms_of(args.ranks)
    if not args.agreement:
        out = csv.writer(sys.stdout, lineterminator="\n")
        out.writerow(("thing", "place", "weight"))
        out.writerows(weights(rooms))
        return
    kin = {name for names in KIN.values() for name in names}
    alike = {where: rows for where, rows in rooms.items() if where[0] in kin}
    print("| people | the same first place | of pairs |\n|---|---|---|")
    for who, choices in (
        ("Housekeep's, all objects", firsts(rooms, ours=False)),
        ("Housekeep's, objects like our things", firsts(alike, ours=False)),
        ("Housekeep's, these by our classes of furniture", firsts(alike, ours=True)),
        ("offline", wished(args.people)),
    ):
        share, count = agreement(choices)
        print(f"| {who} | {share:.3f} | {count} |")


if __name__ == "__main__":
    main()
