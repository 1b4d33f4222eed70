"use strict";
(() => {
  const root = document.documentElement;
  root.classList.add("js");
  const store = { get: () => { try { return localStorage.getItem("coopera-theme"); } catch { return null; } },
    set: (value) => { try { localStorage.setItem("coopera-theme", value); } catch { /* file pages may have no storage */ } } };
  if (store.get()) root.dataset.theme = store.get();
  document.getElementById("theme").addEventListener("click", () => {
    const dark = root.dataset.theme ? root.dataset.theme === "dark" : matchMedia("(prefers-color-scheme: dark)").matches;
    root.dataset.theme = dark ? "light" : "dark";
    store.set(root.dataset.theme);
  });

  const hours = [...document.querySelectorAll("details.hour")];
  const chips = [...document.querySelectorAll(".chips button")];
  const find = document.getElementById("find"), shown = document.getElementById("shown"), open = document.getElementById("open");
  if (!find) return;
  const texts = new Map();
  const text = (hour) => {
    if (!texts.has(hour)) texts.set(hour, hour.textContent.toLowerCase());
    return texts.get(hour);
  };
  let flag = "";
  const apply = () => {
    const words = find.value.trim().toLowerCase();
    let count = 0;
    for (const hour of hours) {
      const fits = (!flag || hour.dataset.flags.split(" ").includes(flag)) && (!words || text(hour).includes(words));
      hour.hidden = !fits;
      count += fits;
    }
    for (const day of document.querySelectorAll("section.day")) {
      const some = [...day.querySelectorAll("details.hour")].some((hour) => !hour.hidden);
      day.hidden = !some;
    }
    shown.textContent = `${count} of ${hours.length} hours`;
  };
  for (const chip of chips) {
    const of = chip.dataset.flag;
    const count = of ? hours.filter((hour) => hour.dataset.flags.split(" ").includes(of)).length : hours.length;
    chip.append(` ${count}`);
    chip.addEventListener("click", () => {
      flag = of;
      for (const other of chips) other.setAttribute("aria-pressed", String(other === chip));
      apply();
    });
  }
  find.addEventListener("input", apply);
  open.addEventListener("click", () => {
    const all = hours.filter((hour) => !hour.hidden), closed = all.some((hour) => !hour.open);
    for (const hour of all) hour.open = closed;
    open.textContent = closed ? "Close all" : "Open all";
  });
  apply();

  const jump = () => {
    const target = location.hash && document.getElementById(location.hash.slice(1));
    if (!target) return;
    if (target.hidden || target.closest("section.day[hidden]")) { find.value = ""; chips[0].click(); }
    if (target.matches("details.hour")) target.open = true;
    requestAnimationFrame(() => target.scrollIntoView({ behavior: "instant" }));
  };
  addEventListener("hashchange", jump);
  document.addEventListener("click", (event) => {
    const link = event.target.closest('a[href^="#"]');
    if (link && link.getAttribute("href") === location.hash) jump();
  });
  jump();

  const show = (strip, index) => {
    const reel = strip.closest(".reel");
    for (const other of reel.querySelectorAll(".strip")) {
      const frames = [...other.children], at = Math.min(index, frames.length - 1);
      frames.forEach((frame, n) => frame.classList.toggle("on", n === at));
      other.parentElement.querySelector(".big").src = frames[at].src;
    }
  };
  const fill = (hour) => {
    const strip = hour.querySelector(".strip");
    if (strip && !hour.querySelector(".big").src) show(strip, strip.children.length >> 1); // the middle of the deed
  };
  document.addEventListener("toggle", (event) => { if (event.target.matches("details.hour[open]")) fill(event.target); }, true);
  document.addEventListener("pointerover", (event) => {
    const frame = event.target.closest(".strip img");
    if (frame) show(frame.parentElement, [...frame.parentElement.children].indexOf(frame));
  });
  let playing = 0;
  document.addEventListener("pointerover", (event) => {
    const big = event.target.closest(".big");
    clearInterval(playing);
    if (!big || matchMedia("(prefers-reduced-motion: reduce)").matches) return;
    const strip = big.closest("figure").querySelector(".strip");
    let n = 0;
    playing = setInterval(() => show(strip, n++ % strip.children.length), 350);
  });
  const light = document.getElementById("light");
  document.addEventListener("click", (event) => {
    const frame = event.target.closest(".big, .strip img");
    if (frame) { light.firstElementChild.src = frame.src; light.hidden = false; }
    else light.hidden = true;
  });
  addEventListener("keydown", (event) => { if (event.key === "Escape") light.hidden = true; });
})();
