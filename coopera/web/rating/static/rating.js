"use strict";
(() => {
  const at = (id) => document.getElementById(id);
  const unit = at("unit");
  if (!unit) return;
  const asks = [...unit.querySelectorAll(".ask")], undo = [];
  const pressed = (ask) => ask.querySelector("[aria-pressed=true]");
  const refresh = () => {
    at("next").setAttribute("aria-disabled", String(!asks.every(pressed)));
    at("undo").disabled = undo.length === 0;
    const open = asks.find((ask) => !pressed(ask));
    for (const ask of asks) ask.classList.toggle("here", ask === open);
  };
  const tell = (text) => { at("problem").hidden = !text; at("problem").textContent = text || ""; };
  // What was chosen is shown at once and sent until the server has it; one after another, so that the last word counts.
  let queue = Promise.resolve();
  const send = (item, said) => {
    queue = queue.then(async () => {
      for (;;) {
        try {
          const found = await coopera.post(`${unit.dataset.address}/say`, { item, said });
          at("line").hidden = true;
          at("count").textContent = `${found.answered} of ${found.of}`;
          at("bar").style.setProperty("--p", found.answered / (found.of || 1));
          tell("");
          return;
        } catch (err) {
          if (err.status) { tell(err.message); return; }
          at("line").hidden = false;
          await new Promise((go) => setTimeout(go, 1500));
        }
      }
    });
    return queue;
  };
  const choose = (ask, said) => {
    const before = pressed(ask);
    undo.push([ask, before ? before.dataset.said : "undo"]);
    set(ask, said);
  };
  const set = (ask, said) => {
    for (const button of ask.querySelectorAll("button")) button.setAttribute("aria-pressed", String(button.dataset.said === said));
    send(ask.querySelector("button").dataset.item, said);
    refresh();
  };
  unit.addEventListener("click", (event) => {
    const button = event.target.closest("[data-said]");
    if (!button) return;
    choose(button.closest(".ask"), button.getAttribute("aria-pressed") === "true" ? "undo" : button.dataset.said);
  });
  at("undo").addEventListener("click", () => { const last = undo.pop(); if (last) set(...last); });
  at("next").addEventListener("click", async (event) => {
    event.preventDefault();
    if (at("next").getAttribute("aria-disabled") === "true") return;
    await queue;
    location.assign(at("next").href);
  });
  document.addEventListener("keydown", (event) => {
    const said = { y: "yes", n: "no", s: "skip" }[event.key];
    const open = asks.find((ask) => !pressed(ask));
    if (said && open && !event.ctrlKey && !event.metaKey && !event.altKey) { choose(open, said); open.scrollIntoView({ block: "nearest" }); }
    if (event.key === "Enter" && event.target === document.body) at("next").click();
  });
  refresh();
})();
