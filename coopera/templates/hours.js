"use strict";
// Hours on a page: filters and search, keys, films, and prompts that are unpacked when they are looked at.
(() => {
  const all = (what, within = document) => [...within.querySelectorAll(what)];
  const find = document.getElementById("find"), shown = document.getElementById("shown"), open = document.getElementById("open");
  const chips = all(".chips button[data-flag]");
  let hours = [], flag = "", texts = new Map();

  // Filters

  const fits = (hour, words) => {
    if (!texts.has(hour)) texts.set(hour, hour.textContent.toLowerCase());
    return (!flag || hour.dataset.flags.split(" ").includes(flag)) && (!words || texts.get(hour).includes(words));
  };
  const keep = () => { // what the pages of the hours walk by
    try {
      const some = flag || find.value.trim();
      const walk = { name: some ? [chips.find((one) => one.dataset.flag === flag)?.dataset.name, find.value.trim()].filter(Boolean).join(", ") : "",
        hours: some ? hours.filter((hour) => !hour.hidden).map((hour) => hour.getAttribute("href")) : [] };
      sessionStorage.setItem(`coopera-walk:${new URL(".", location.href).pathname}`, JSON.stringify(walk));
    } catch { /* no storage */ }
  };
  const apply = () => {
    const words = find.value.trim().toLowerCase();
    let count = 0;
    for (const hour of hours) {
      hour.hidden = !fits(hour, words);
      count += !hour.hidden;
    }
    for (const day of all("section.day")) day.hidden = hours.length > 0 && all(".hour", day).every((hour) => hour.hidden);
    const seen = new Set(hours.filter((hour) => !hour.hidden).map((hour) => hour.id));
    for (const cell of all(".map a.cell[data-of]")) cell.classList.toggle("faint", !seen.has(cell.dataset.of));
    shown.textContent = `${count} of ${hours.length} hours`;
    if (hours[0]?.matches("a")) keep();
  };
  const choose = (chip) => {
    flag = chip.dataset.flag;
    for (const other of chips) other.setAttribute("aria-pressed", String(other === chip));
    apply();
  };
  const gather = () => {
    hours = all(".hour");
    texts = new Map();
    for (const chip of chips) {
      const of = chip.dataset.flag;
      chip.dataset.name ||= of ? chip.textContent.trim() : "";
      chip.textContent = `${chip.dataset.name || "All hours"} ${of ? hours.filter((hour) => hour.dataset.flags.split(" ").includes(of)).length : hours.length}`;
    }
    if (find && shown) apply();
  };
  for (const chip of chips) chip.addEventListener("click", () => choose(chip));
  find?.addEventListener("input", () => { if (shown) apply(); });
  document.addEventListener("coopera:changed", gather);
  gather();

  // Opening

  open?.addEventListener("click", () => {
    const some = hours.filter((hour) => !hour.hidden), closed = some.some((hour) => !hour.open);
    for (const hour of some) hour.open = closed;
    open.textContent = closed ? "Close all" : "Open all";
  });
  const jump = () => {
    const target = location.hash && document.getElementById(decodeURIComponent(location.hash.slice(1)));
    if (!target) return;
    if (find && (target.hidden || target.closest("section.day[hidden]"))) { find.value = ""; choose(chips[0]); }
    if (target.matches("details.hour")) target.open = true;
    requestAnimationFrame(() => target.scrollIntoView({ behavior: "instant" }));
  };
  addEventListener("hashchange", jump);
  document.addEventListener("click", (event) => {
    const link = event.target.closest('a[href^="#"]');
    if (link && link.getAttribute("href") === location.hash) jump();
  });
  jump();

  // Films

  const source = (frame) => { if (frame.dataset.src) { frame.src = frame.dataset.src; delete frame.dataset.src; } return frame.src; };
  const show = (strip, index) => {
    for (const other of all(".strip", strip.closest(".reel"))) {
      const frames = [...other.children], at = Math.min(index, frames.length - 1);
      frames.forEach((frame, n) => frame.classList.toggle("on", n === at));
      const big = other.parentElement.querySelector(".big");
      big.src = source(frames[at]);
      big.alt = frames[at].alt;
    }
  };
  const fill = (within) => {
    for (const frame of all(".shots img", within)) source(frame);
    for (const strip of all(".strip", within)) {
      for (const frame of strip.children) source(frame);
      if (!strip.parentElement.querySelector(".big").src) show(strip, strip.children.length >> 1); // the middle of the deed
    }
  };
  let playing = 0;
  const play = (strip, times) => {
    clearInterval(playing);
    let n = 0;
    playing = setInterval(() => { if (n >= times) clearInterval(playing); else show(strip, n++ % strip.children.length); }, 350);
  };
  const stripOf = (part) => part.closest("figure").querySelector(".strip");
  document.addEventListener("pointerover", (event) => {
    const frame = event.target.closest(".strip img"), big = event.target.closest(".big");
    if (frame) { clearInterval(playing); show(frame.parentElement, [...frame.parentElement.children].indexOf(frame)); }
    else if (big && event.pointerType === "mouse" && !matchMedia("(prefers-reduced-motion: reduce)").matches) play(stripOf(big), Infinity);
    else if (event.pointerType === "mouse" && !event.target.closest("figure")) clearInterval(playing);
  });
  const light = document.getElementById("light");
  const enlarge = (frame) => { light.firstElementChild.src = frame.src; light.firstElementChild.alt = frame.alt; light.showModal(); };
  document.addEventListener("click", (event) => {
    const frame = event.target.closest(".big, .strip img, .shots img"), button = event.target.closest(".play");
    if (button) { const strip = stripOf(button); play(strip, 2 * strip.children.length); }
    else if (frame && light) enlarge(frame);
    else if (light?.open) light.close();
  });
  for (const strip of all("main > .strip, .page-hour .strip")) fill(strip.closest(".reel").parentElement);
  document.addEventListener("error", (event) => {
    if (event.target.matches?.(".strip img, .shots img")) { event.target.classList.add("gone"); event.target.alt += " (the file is missing)"; }
  }, true);

  // Prompts that are packed

  const days = new Map();
  const unpack = (day) => {
    if (!days.has(day)) {
      days.set(day, (async () => {
        const text = document.querySelector(`template[data-pack="${day}"]`).content.textContent;
        const bytes = Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
        const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
        return JSON.parse(await new Response(stream).text());
      })());
    }
    return days.get(day);
  };
  const tell = async (call) => {
    const of = call.dataset.prompts;
    if (!of) return;
    delete call.dataset.prompts;
    try {
      const said = (await unpack(of.match(/^d\d+/)[0]))[of][call.dataset.call];
      for (const [role, text, images] of said) {
        const part = document.createElement("div"), head = document.createElement("h4"), words = document.createElement("pre");
        part.className = role === "reply" ? "said reply" : "said";
        head.textContent = [role, ...images].join(" · ");
        words.textContent = text;
        words.dir = "auto";
        part.append(head, words);
        call.append(part);
      }
    } catch {
      const sorry = document.createElement("p");
      sorry.textContent = "This browser cannot unpack prompts and replies; coopera view shows them.";
      call.append(sorry);
    }
  };
  document.addEventListener("toggle", (event) => {
    if (event.target.matches("details.hour[open]")) fill(event.target);
    if (event.target.matches("details.call[open]")) tell(event.target);
  }, true);
  let closed = [];
  addEventListener("beforeprint", () => {
    closed = all("details.hour:not([open])").filter((hour) => !hour.hidden);
    for (const hour of closed) { hour.open = true; fill(hour); }
  });
  addEventListener("afterprint", () => { for (const hour of closed) hour.open = false; });

  // Keys

  const keys = document.getElementById("keys");
  for (const ask of all(".ask")) ask.addEventListener("click", () => keys.showModal());
  const link = (name) => document.querySelector(`[data-key="${name}"]`);
  let walk = null;
  try { walk = JSON.parse(sessionStorage.getItem(`coopera-walk:${new URL("..", location.href).pathname}`)); } catch { /* none */ }
  const page = document.querySelector("[data-hour]");
  const walking = page && walk?.hours.length ? walk : null;
  if (walking) {
    const at = document.getElementById("walk"), here = walking.hours.indexOf(page.dataset.hour);
    if (at) at.textContent = `Walking by the filter: ${walking.name} (${here < 0 ? "outside" : here + 1} of ${walking.hours.length})`;
  }
  const step = (by, day) => {
    if (page) { // a page of one hour
      const name = day ? (by > 0 ? "J" : "K") : by > 0 ? "j" : "k";
      if (walking && !day) {
        const order = walking.hours, here = order.indexOf(page.dataset.hour);
        const next = here >= 0 ? order[here + by]
          : by > 0 ? order.find((one) => one > page.dataset.hour) : order.findLast((one) => one < page.dataset.hour);
        if (next) location.href = new URL(next, new URL("..", location.href)).href;
      } else link(name)?.click();
      return;
    }
    const some = hours.filter((hour) => !hour.hidden);
    const spot = (hour) => hour.matches("a") ? hour : hour.querySelector("summary");
    const here = some.findIndex((hour) => hour.contains(document.activeElement));
    let next = here < 0 ? (by > 0 ? 0 : -1) : here + by;
    if (day && here >= 0) {
      const of = (hour) => hour.closest("section.day");
      const sections = all("section.day").filter((one) => !one.hidden), at = sections.indexOf(of(some[here])) + by;
      next = some.findIndex((hour) => of(hour) === sections[at]);
      if (next < 0) return;
    }
    const target = some.at(Math.min(next, some.length - 1));
    if (!target || next < -1) return;
    spot(target).focus();
    target.scrollIntoView({ block: "nearest" });
  };
  addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey || event.defaultPrevented) return;
    if (event.target.matches?.("input, textarea, select")) { if (event.key === "Escape") event.target.blur(); return; }
    if (document.querySelector("dialog[open]")) return;
    const acts = {
      j: () => step(1, false), k: () => step(-1, false), J: () => step(1, true), K: () => step(-1, true),
      "/": () => (find ?? document.querySelector("input[type=search]"))?.focus(), "?": () => keys?.showModal(),
      u: () => link("u")?.click(),
      c: () => { const calls = document.querySelector(".hour[open]:focus-within .calls, .page-hour .calls, .hour[open] .calls"); if (calls) { calls.open = !calls.open; calls.scrollIntoView({ block: "start" }); } },
      Enter: () => { if (event.target.matches?.(".big")) enlarge(event.target); },
    };
    const act = /^[0-9]$/.test(event.key) ? chips[event.key] && (() => choose(chips[event.key])) : acts[event.key];
    if (!act) return;
    if (event.key !== "Enter") event.preventDefault();
    act();
  });
})();
