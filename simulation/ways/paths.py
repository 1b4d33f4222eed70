"""Shortest ways on a graph whose nodes lie in rooms: worked out once within each room, and joined where rooms meet.

A way to another room passes the doors, of which there are few. So a home's ways are the ways within its rooms from
each node at a door, and the ways between these nodes; every other way is put together from them, exactly.
"""

from __future__ import annotations

import math
from functools import cached_property, lru_cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_matrix
from scipy.sparse.csgraph import dijkstra

from coopera.simulation.ways.floor import Array, Nodes

_REMEMBERED = 64
_DETOUR = 2.0
_MOST_DOORS, _MOST_WAYS = 600, 6_000_000
"""A home with more nodes at doors, or more ways from them, is taken as one room: that is slower, and needs less."""


class _Tree(NamedTuple):
    """Costs of the ways from some nodes of a room to all of its nodes, and the node before each; shape (doors, n)."""

    cost: Array
    before: NDArray[np.int32]


class Ways:
    """The shortest ways between the nodes of one undirected graph. Of equal ones it always gives the same."""

    def __init__(self, graph: csr_matrix, rooms: Nodes) -> None:
        """Take a graph with positive weights, symmetric, and the number of each node's room."""
        self._graph = graph
        self._room = self._divided(rooms)
        self._members = [np.flatnonzero(self._room == index) for index in range(int(self._room.max()) + 1)]
        self._place = np.zeros(len(self._room), dtype=np.int64)
        for members in self._members:
            self._place[members] = np.arange(len(members))
        self._inner = [graph[members][:, members] for members in self._members]
        self._from = lru_cache(maxsize=_REMEMBERED)(self._work_out_from)

    def _divided(self, rooms: Nodes) -> Nodes:
        """The rooms of the nodes, or one room for all where rooms are too open to one another."""
        doors = _at_doors(self._graph, rooms)
        ways = (np.bincount(rooms[doors], minlength=int(rooms.max()) + 1) * np.bincount(rooms)).sum()
        return np.zeros_like(rooms) if len(doors) > _MOST_DOORS or ways > _MOST_WAYS else rooms

    def costs(self, first: int, nodes: Nodes) -> Array:
        """Cost of the way from a node to each of some nodes of one room; inf where there is none."""
        if not len(nodes):
            return np.zeros(0)
        here, there = int(self._room[first]), int(self._room[nodes[0]])
        places = self._place[nodes]
        found = np.full(len(nodes), np.inf)
        if here == there:
            found = self._from(first).cost[0, places]
        if len(self._doors_of[here]) and len(self._doors_of[there]):
            out = self._trees[here].cost[:, self._place[first]]
            across = (out[:, None] + self._between[np.ix_(self._doors_of[here], self._doors_of[there])]).min(axis=0)
            found = np.minimum(found, (across[:, None] + self._trees[there].cost[:, places]).min(axis=0))
        return found

    def chain(self, first: int, last: int) -> list[int] | None:
        """The nodes of a shortest way between two nodes, both included; None where there is no way."""
        here, there = int(self._room[first]), int(self._room[last])
        a, b = int(self._place[first]), int(self._place[last])
        direct = float(self._from(first).cost[0, b]) if here == there else math.inf
        outs, ins = self._doors_of[here], self._doors_of[there]
        if len(outs) and len(ins):
            out, into = self._trees[here].cost[:, a], self._trees[there].cost[:, b]
            around = out[:, None] + self._between[np.ix_(outs, ins)] + into
            best = int(around.argmin())
            if around.flat[best] < direct:
                i, j = divmod(best, len(ins))
                way = self._within(here, i, a)
                way += self._across(int(outs[i]), int(ins[j]))[1:]
                return way + self._within(there, j, b)[-2::-1]
        if math.isinf(direct):
            return None
        return self._walk_back(here, self._from(first).before[0], b)[::-1]

    def costs_around(self, first: int, closed: Nodes, farthest: float = math.inf) -> Array:
        """Cost of the way from a node to each, where nothing leads out of closed ones; inf beyond `farthest`."""
        cost: Array = dijkstra(self._without(closed), indices=first, limit=farthest)
        return cost

    def chain_around(self, first: int, last: int, closed: Nodes) -> list[int] | None:
        """The nodes of a shortest way between two nodes where nothing leads out of closed ones; None without one."""
        graph, straight = self._without(closed), float(self.costs(first, np.array([last]))[0])
        for farthest in (straight + _DETOUR, math.inf):  # most detours are short
            cost, before = dijkstra(graph, indices=first, return_predecessors=True, limit=farthest)
            if math.isfinite(cost[last]):
                break
        else:
            return None
        nodes = [last]
        while nodes[-1] != first:
            nodes.append(int(before[nodes[-1]]))
        return nodes[::-1]

    def _without(self, closed: Nodes) -> csr_matrix:
        graph = csr_matrix((self._graph.data.copy(), self._graph.indices, self._graph.indptr), shape=self._graph.shape)
        for node in closed:
            graph.data[graph.indptr[node] : graph.indptr[node + 1]] = np.inf
        return graph

    def _work_out_from(self, first: int) -> _Tree:
        """The ways from one node to all of its room that do not leave the room."""
        return self._tree(int(self._room[first]), self._place[[first]])

    def _tree(self, room: int, places: Nodes) -> _Tree:
        cost, before = dijkstra(self._inner[room], indices=places, return_predecessors=True)
        return _Tree(cost, before)

    @cached_property
    def _doors(self) -> Nodes:
        """The nodes from which a step leads into another room, in the order of their rooms."""
        doors = _at_doors(self._graph, self._room)
        return doors[np.argsort(self._room[doors], kind="stable")]

    @cached_property
    def _doors_of(self) -> list[Nodes]:
        """For each room its places among the doors."""
        return [np.flatnonzero(self._room[self._doors] == index) for index in range(len(self._members))]

    @cached_property
    def _trees(self) -> list[_Tree]:
        """For each room the ways within it from each of its doors."""
        return [
            self._tree(room, self._place[self._doors[doors]]) if len(doors) else _Tree(np.zeros((0, 0)), _NOWHERE)
            for room, doors in enumerate(self._doors_of)
        ]

    @cached_property
    def _joined(self) -> _Tree:
        """The ways from each door to each, through any rooms."""
        steps = self._graph[self._doors][:, self._doors].toarray()
        for room, doors in enumerate(self._doors_of):
            if len(doors):
                inside = self._trees[room].cost[:, self._place[self._doors[doors]]]
                steps[np.ix_(doors, doors)] = np.where(np.isfinite(inside), inside, 0.0)
        return _Tree(*dijkstra(csr_matrix(steps), return_predecessors=True))

    @property
    def _between(self) -> Array:
        return self._joined.cost

    def _across(self, door: int, other: int) -> list[int]:
        """The nodes on the way from one door to another."""
        stops = [other]
        while stops[-1] != door:
            stops.append(int(self._joined.before[door, stops[-1]]))
        nodes = [int(self._doors[door])]
        for a, b in zip(stops[::-1], stops[-2::-1], strict=False):
            one, two = int(self._doors[a]), int(self._doors[b])
            room = int(self._room[one])
            if room == self._room[two]:
                row = a - int(self._doors_of[room][0])
                nodes += self._within(room, row, int(self._place[two]))[-2::-1]
            else:
                nodes.append(two)
        return nodes

    def _within(self, room: int, row: int, place: int) -> list[int]:
        """The nodes on the way from a place of a room back to one of its doors."""
        return self._walk_back(room, self._trees[room].before[row], place)

    def _walk_back(self, room: int, before: NDArray[np.int32], place: int) -> list[int]:
        members, nodes = self._members[room], []
        while place >= 0:
            nodes.append(int(members[place]))
            place = int(before[place])
        return nodes


_NOWHERE = np.zeros((0, 0), dtype=np.int32)


def _at_doors(graph: csr_matrix, rooms: Nodes) -> Nodes:
    heads = np.repeat(np.arange(len(rooms)), np.diff(graph.indptr))
    return np.unique(heads[rooms[heads] != rooms[graph.indices]])
