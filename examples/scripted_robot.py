"""A scripted robot in a Gymnasium environment: it watches each hour's first task, and brings what was in hand then.

.venv/bin/python examples/scripted_robot.py [PERSON [SCENE]]    (needs the extra `gym`)
"""

from __future__ import annotations

import sys

import coopera


def main(person: str = "amara", scene: str = "maple") -> None:
    """Live four days of six hours; from the second on, bring once what the person held at this hour before."""
    env = coopera.make_env(person, scene, days=4, hours=6, collab=2, overlap=True)
    things, held, now, over = env.coding, dict[int, set[int]](), -1, False
    seen, _ = env.reset(seed=0)
    while not over:
        if seen["clock"][1] != now:
            now = int(seen["clock"][1])
            brings = sorted(held.get(now, ()))
            act = [0, 0, 0]  # watch the first task
        else:
            act = [3, brings.pop(), 0] if brings else [0, 0, 0]
        seen, reward, over, _, info = env.step(act)
        if seen["person"][3] and seen["clock"][1] == now:  # the class of what was seen in the person's hand
            held.setdefault(now, set()).add(things.thing(things.classes[seen["person"][3] - 1]))
        print(f"{now:02d} h {reward:+.1f}  {info['act'] or 'watches'} {info['reason']}")
    print(info["help"])
    env.close()


if __name__ == "__main__":
    main(*sys.argv[1:])
