"use strict";
(() => {
  const at = (id) => document.getElementById(id);
  const now = at("now"), toast = at("problem"), line = at("line"), pause = at("pause");
  const keep = (store, name, value) => {
    try { if (value !== undefined) store.setItem(name, value); return store.getItem(name) || ""; } catch { return ""; }
  };
  // Each tab names itself, and keeps the name through a reload.
  let page = keep(sessionStorage, "coopera-page");
  if (!page) {
    page = [...crypto.getRandomValues(new Uint8Array(12))].map((byte) => byte.toString(16).padStart(2, "0")).join("");
    keep(sessionStorage, "coopera-page", page);
  }
  let shown = { version: "", question: "", revision: 0 }, busy = false, undo = [], timer = 0;
  let paused = keep(sessionStorage, "coopera-paused") === "1";

  // What is typed and not yet given stays in this browser, for the question that it was typed for.
  const typedName = () => `coopera-typed-${shown.question}`;
  const typed = () => { try { return JSON.parse(keep(localStorage, typedName()) || "{}"); } catch { return {}; } };
  const forget = () => { try { localStorage.removeItem(typedName()); } catch { /* no storage */ } };
  now.addEventListener("input", (event) => {
    const { id, value } = event.target;
    if (id && !event.target.dataset.reason) keep(localStorage, typedName(), JSON.stringify({ ...typed(), [id]: value }));
  });

  const show = (answer) => {
    const problem = answer.problem;
    if (answer.html !== undefined && answer.version !== shown.version) {
      const focus = document.activeElement && document.activeElement.id;
      if (answer.question !== shown.question) { undo = []; window.scrollTo(0, 0); }
      shown = answer;
      now.innerHTML = answer.html;
      for (const [id, value] of Object.entries(typed())) if (at(id) && !at(id).value) at(id).value = value;
      if (focus && at(focus)) at(focus).focus({ preventScroll: true });
      pause.hidden = !(answer.seat === "yours" && ["question", "living", "consent"].includes(answer.status));
      if (at("undo-verdict")) at("undo-verdict").disabled = undo.length === 0;
      mark();
      if (answer.seat === "free" && !paused && answer.status !== "over") act("sit", {});
    }
    tell(problem);
  };
  const tell = (problem) => {
    const place = at("line-problem");
    if (place) place.textContent = problem || "";
    toast.hidden = !problem || Boolean(place);
    toast.textContent = problem || "";
    const first = place && problem && now.querySelector("#text, #words, #motion");
    if (place) for (const field of now.querySelectorAll("#text, #words, #motion")) field.removeAttribute("aria-invalid");
    if (first) first.setAttribute("aria-invalid", "true");
  };
  const connected = (is) => { line.hidden = is; };

  const poll = async () => {
    clearTimeout(timer);
    if (!busy) {
      try {
        const answer = await fetch(`/now?page=${page}&seen=${encodeURIComponent(shown.version)}`, { credentials: "same-origin" });
        if (answer.ok) { const found = await answer.json(); connected(true); if (found.html !== undefined) show(found); }
      } catch { connected(shown.status === "over"); }
    }
    timer = setTimeout(poll, shown.status === "over" ? 20000 : 1000);
  };
  // Tries until it is through: what was given is kept here until the server has it.
  const act = async (what, data) => {
    if (busy) return false;
    busy = true;
    now.setAttribute("aria-busy", "true");
    try {
      for (;;) {
        try {
          const answer = await coopera.post(`/do/${what}`, { page, question: shown.question, revision: shown.revision, ...data });
          connected(true);
          busy = false;
          show(answer);
          return !answer.problem;
        } catch (err) {
          if (err.status) {
            connected(true);
            busy = false;
            tell(err.message);
            return false;
          }
          connected(false);
          await new Promise((go) => setTimeout(go, 1500));
        }
      }
    } finally { busy = false; now.removeAttribute("aria-busy"); }
  };

  const value = (id) => (at(id) ? at(id).value.trim() : "");
  const step = () => {
    const words = value("words");
    if (words) return words.replaceAll("|", "/");
    return at("step").dataset.collab === "1" ? `${value("thing")} | ${value("place")}` : `${value("place")} | ${value("motion")} | ${value("hand")}`;
  };
  const missing = () => {
    if (value("words")) return "";
    if (at("thing") && !value("thing")) return "Please choose a thing, or say it in your own words.";
    if (!value("place")) return "Please choose a place, or say it in your own words.";
    if (at("motion") && !value("motion")) return "Please say what you do there.";
    if (at("hand") && !value("hand")) return "Please say what you have in your hand.";
    return "";
  };
  now.addEventListener("submit", async (event) => {
    event.preventDefault();
    const kind = event.target.dataset.form;
    if (kind === "agree") await act("agree", { participant: value("participant"), agrees: Boolean(at("agrees") && at("agrees").checked) });
    if (kind === "intention") { if (await act("say", { do: "intention", text: value("text") })) forget(); }
    if (kind === "step") {
      if (missing()) { tell(missing()); return; }
      const name = typedName();
      if (await act("say", { do: "step", text: step() })) {
        try { localStorage.removeItem(name); } catch { /* no storage */ }
        for (const id of ["words", "thing", "place", "motion", "hand"]) if (at(id)) at(id).value = "";
        mark();
        (at("place") || at("undo")).focus({ preventScroll: true });
      }
    }
  });
  now.addEventListener("click", async (event) => {
    const button = event.target.closest("[data-do],[data-remove],[data-undo],[data-verdict],[data-place],[data-thing],[data-idea],#undo-verdict");
    if (!button || button.disabled) return;
    const data = button.dataset;
    if (data.do === "take" || data.do === "sit") { paused = false; keep(sessionStorage, "coopera-paused", "0"); await act("sit", { take: data.do === "take" }); }
    else if (data.do === "finish") { button.disabled = true; if (!(await act("say", { do: "finish" })) && button.isConnected) button.disabled = false; }
    else if (data.remove !== undefined) await act("say", { do: "remove", at: Number(data.remove) });
    else if (data.undo !== undefined) await act("say", { do: "remove", at: Number(data.undo) });
    else if (data.verdict !== undefined) await verdict(Number(data.at), button.getAttribute("aria-pressed") === "true" ? "" : data.verdict);
    else if (button.id === "undo-verdict" && undo.length) {
      const [place, before] = undo.pop();
      await act("say", { do: "verdict", at: place, text: before });
    } else if (data.idea !== undefined) { at("motion").value = data.idea; at("hand").focus(); }
    else pick(button);
  });
  now.addEventListener("keydown", (event) => {
    const thing = event.target.closest("[data-place],[data-thing]");
    if (thing && (event.key === "Enter" || event.key === " ")) { event.preventDefault(); pick(thing); }
  });
  const said = (place) => {
    const chosen = now.querySelector(`[data-at="${place}"][aria-pressed=true]`), reason = at(`r${place}`);
    if (!chosen) return "";
    return reason && reason.defaultValue ? `${chosen.dataset.verdict}, ${reason.defaultValue}` : chosen.dataset.verdict;
  };
  const verdict = async (place, choice) => {
    const before = said(place), reason = value(`r${place}`);
    undo.push([place, before]);
    const text = choice && reason && choice !== "skip" ? `${choice}, ${reason}` : choice;
    if (!(await act("say", { do: "verdict", at: place, text }))) undo.pop();
    if (at("undo-verdict")) at("undo-verdict").disabled = undo.length === 0;
  };
  now.addEventListener("change", (event) => {
    const { reason, choice } = event.target.dataset;
    if (reason !== undefined) verdict(Number(reason), choice);
    if (event.target.id === "place" || event.target.id === "thing") mark();
  });
  const pick = (thing) => {
    const field = thing.dataset.place !== undefined ? at("place") : at("thing");
    if (!field) return;
    field.value = thing.dataset.place ?? thing.dataset.thing;
    field.dispatchEvent(new Event("input", { bubbles: true }));
    mark();
  };
  // Shows on the plan what is chosen, and names motions that can be done there.
  const mark = () => {
    for (const one of now.querySelectorAll("[data-place],[data-thing]")) {
      one.classList.toggle("chosen", (one.dataset.place ?? one.dataset.thing) === value(one.dataset.place !== undefined ? "place" : "thing"));
    }
    const ideas = at("ideas");
    if (!ideas) return;
    const here = JSON.parse(ideas.dataset.can)[value("place")] || JSON.parse(ideas.dataset.any);
    ideas.replaceChildren(...here.slice(0, 6).map((text) => {
      const button = document.createElement("button");
      button.type = "button";
      button.dataset.idea = text;
      button.textContent = text;
      return button;
    }));
  };
  now.addEventListener("pointerover", (event) => {
    const thing = event.target.closest("[data-say]");
    if (thing && at("spot")) at("spot").textContent = thing.dataset.say;
  });
  pause.addEventListener("click", async () => {
    paused = true;
    keep(sessionStorage, "coopera-paused", "1");
    await act("leave", {});
  });
  window.addEventListener("online", poll);
  document.addEventListener("visibilitychange", () => { if (!document.hidden) poll(); });
  poll();
})();
