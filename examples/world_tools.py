"""A home as LangChain tools: let a tool-calling model tidy up.

`.venv/bin/python examples/world_tools.py` carries out calls that are written down here, in the form in which a model
makes them. With a model's name it asks the model instead (needs the extra `openai`):
`.venv/bin/python examples/world_tools.py openai:llama-3.1-8b --base-url http://localhost:8000/v1`.
"""

from __future__ import annotations

import argparse
from typing import Any

from langchain_core.messages import AIMessage, HumanMessage, ToolCall

from coopera.simulation import World, load_scene
from coopera.simulation.tools import world_tools

GOAL = "Put one mug on the coffee table in the living room, then tell me where it is."
WRITTEN = [
    ("look_around", {}),
    ("pick", {"thing": "mug_1"}),
    ("go_to", {"target": "living room"}),
    ("place", {"receptacle": "coffee_table_1"}),
    ("place", {"receptacle": "coffee_table_1"}),
]


def main() -> None:
    """Carry out the calls, of a model where one is named, and print each with its answer."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("model", nargs="?", help="openai:NAME")
    parser.add_argument("--base-url")
    args = parser.parse_args()
    with World(load_scene("maple")) as world:
        tools = {tool.name: tool for tool in world_tools(world, "robot")}
        if args.model:
            _ask(args.model, args.base_url, tools)
        else:
            for number, (name, given) in enumerate(WRITTEN):
                call = ToolCall(name=name, args=given, id=str(number), type="tool_call")
                print(f"{name}({given}) -> {tools[name].invoke(call).content[:200]}")
        print("on(mug, coffee table):", world.holds("on(mug, coffee table)"))


def _ask(name: str, base_url: str | None, tools: dict[str, Any]) -> None:
    """The usual loop of a tool-calling model, at most twenty turns."""
    from langchain_openai import ChatOpenAI  # noqa: PLC0415  (an extra)

    model = ChatOpenAI(model=name.removeprefix("openai:"), base_url=base_url).bind_tools(list(tools.values()))
    messages: list[Any] = [HumanMessage(GOAL)]
    for _ in range(20):
        reply = model.invoke(messages)
        assert isinstance(reply, AIMessage)
        messages.append(reply)
        if not reply.tool_calls:
            print(reply.content)
            return
        for call in reply.tool_calls:
            answer = tools[call["name"]].invoke(call)
            print(f"{call['name']}({call['args']}) -> {answer.content[:200]}")
            messages.append(answer)


if __name__ == "__main__":
    main()
