"use strict";
// The viewer's list and runs: narrowing, choosing two to compare, a page that grows while its run does, and charts that come later.
(() => {
  const all = (what, within = document) => [...within.querySelectorAll(what)];

  // The list

  const narrowing = () => {
    const narrow = document.getElementById("narrow");
    if (!narrow) return;
    const table = document.getElementById(narrow.dataset.for), chips = all(`.chips[data-for="${narrow.dataset.for}"] button`);
    const said = document.getElementById("narrowed"), compare = document.getElementById("compare");
    let state = chips.find((chip) => chip.getAttribute("aria-pressed") === "true")?.dataset.state ?? "";
    const rows = all("tbody tr", table), texts = rows.map((row) => row.textContent.toLowerCase().replaceAll("_", " "));
    const apply = () => {
      const words = narrow.value.toLowerCase().replaceAll("_", " ").split(/\s+/).filter(Boolean);
      let count = 0;
      rows.forEach((row, n) => {
        row.hidden = (state && row.dataset.state !== state) || !words.every((word) => texts[n].includes(word));
        count += !row.hidden;
      });
      said.textContent = count === rows.length ? "" : `${count} of ${rows.length}`;
    };
    narrow.oninput = apply;
    for (const chip of chips) chip.onclick = () => {
      state = chip.dataset.state;
      for (const other of chips) other.setAttribute("aria-pressed", String(other === chip));
      apply();
    };
    for (const link of all("a[data-method]")) link.onclick = () => { narrow.value = link.dataset.method; apply(); };
    if (document.querySelector("main [data-method]") === null || narrow.form.getAttribute("action") === null) narrow.form.onsubmit = (event) => event.preventDefault();
    const chosen = () => all("input.choose:checked", table).map((box) => box.value);
    const ready = () => { compare.disabled = chosen().length !== 2; compare.textContent = chosen().length === 1 ? "Choose one more" : chosen().length > 2 ? "Choose two only" : "Compare two"; };
    table.onchange = ready;
    compare.onclick = () => {
      const home = document.querySelector(".crumbs a").href; let [one, other] = chosen();
      const pairs = document.getElementById("pairs")?.content.textContent.split("\n");
      if (pairs && !pairs.includes(`${one} ${other}`)) {
        if (pairs.includes(`${other} ${one}`)) [one, other] = [other, one];
        else { compare.textContent = "Not written side by side"; return; }
      }
      location.href = new URL(`compare/${one}/${other}/index.html`, home).href;
    };
    if (narrow.value) apply();
    ready();
  };
  narrowing();

  // Charts that come later

  for (const place of all("[data-load]")) {
    fetch(place.dataset.load, { credentials: "same-origin" }).then((answer) => answer.text()).then((text) => {
      const found = new DOMParser().parseFromString(text, "text/html").getElementById("analysis");
      if (found) place.replaceWith(...found.children);
    }).catch(() => { /* the link stays */ });
  }

  // A run that runs

  const live = document.getElementById("live");
  if (!live || !("running" in live.dataset)) return;
  const refresh = async () => {
    const text = await (await fetch(location.href, { credentials: "same-origin" })).text();
    const page = new DOMParser().parseFromString(text, "text/html");
    const ticked = all("input.choose:checked").map((box) => box.value), typed = document.getElementById("narrow")?.value;
    for (const id of ["live", "hours"]) {
      const now = page.getElementById(id), before = document.getElementById(id);
      if (now && before) {
        before.replaceChildren(...now.childNodes);
        if (id === "live") { before.dataset.stamp = now.dataset.stamp; if (!("running" in now.dataset)) delete before.dataset.running; }
      }
    }
    if (!document.getElementById("hours") && page.getElementById("hours")) { location.reload(); return; }
    for (const box of all("input.choose")) box.checked = ticked.includes(box.value);
    if (typed) document.getElementById("narrow").value = typed;
    narrowing();
    document.dispatchEvent(new Event("coopera:changed"));
  };
  const look = async () => {
    try {
      const now = await (await fetch(live.dataset.live, { credentials: "same-origin" })).json();
      if (String(now.stamp) !== live.dataset.stamp) await refresh();
    } catch { /* the server is away for now */ }
    if ("running" in live.dataset) setTimeout(look, document.hidden ? 10000 : 2000);
  };
  setTimeout(look, 1500);
})();
