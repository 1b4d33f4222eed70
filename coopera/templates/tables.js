"use strict";
// Tables that sort by the column whose head is chosen, and charts of which one line is looked at.
(() => {
  const value = (row, at) => {
    const cell = row.cells[at], given = cell?.dataset.sort ?? cell?.textContent.trim() ?? "";
    const number = parseFloat(given.replace(/[,\u202f]/g, ""));
    return Number.isNaN(number) || /^\d{4}-/.test(given) ? given.toLowerCase() : number;
  };
  const compare = (one, other) => {
    if (typeof one === typeof other) return one < other ? -1 : one > other ? 1 : 0;
    return typeof one === "number" ? 1 : -1;
  };
  document.addEventListener("click", (event) => {
    const sort = event.target.closest("table[data-sorted] .sort");
    if (sort) {
      const head = sort.closest("th"), at = head.cellIndex, body = head.closest("table").tBodies[0];
      const up = head.getAttribute("aria-sort") ? head.getAttribute("aria-sort") === "descending" : !head.classList.contains("number");
      for (const other of head.parentElement.cells) other.removeAttribute("aria-sort");
      head.setAttribute("aria-sort", up ? "ascending" : "descending");
      body.append(...[...body.rows].sort((one, other) => (up ? 1 : -1) * compare(value(one, at), value(other, at))));
    }
    const chosen = event.target.closest("figure[data-figure] button[data-line]");
    if (chosen) {
      const figure = chosen.closest("figure"), on = chosen.getAttribute("aria-pressed") !== "true";
      chosen.setAttribute("aria-pressed", String(on));
      const lines = [...figure.querySelectorAll("button[aria-pressed=true]")].map((one) => one.dataset.line);
      figure.classList.toggle("chosen", lines.length > 0);
      for (const mark of figure.querySelectorAll("svg .line, svg .dot")) mark.classList.toggle("on", lines.some((line) => mark.classList.contains(line)));
    }
  });
})();
