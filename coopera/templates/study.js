"use strict";
const form = document.getElementById("study");
const said = document.getElementById("said");
document.getElementById("print").addEventListener("click", () => window.print());
form.addEventListener("submit", (event) => {
  event.preventDefault();
  const given = new FormData(form);
  const participant = String(given.get("participant") || "").trim();
  if (!participant) {
    said.textContent = "Please fill in your name or number at the top.";
    form.elements.participant.focus();
    return;
  }
  const answers = {};
  for (const [name, value] of given) if (name !== "participant") answers[name] = value;
  const data = { study: form.dataset.study, participant, answers };
  const link = document.createElement("a");
  link.href = URL.createObjectURL(new Blob([JSON.stringify(data, null, 1)], { type: "application/json" }));
  link.download = `answers-${participant.replace(/[^A-Za-z0-9_-]+/g, "-")}.json`;
  link.click();
  URL.revokeObjectURL(link.href);
  said.textContent = `${Object.keys(answers).length} answers saved. Thank you.`;
});
