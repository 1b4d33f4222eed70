"use strict";
// What every page has: light and dark, and posting with the form token. Loaded in the head, so that no page flashes.
const coopera = (() => {
  const root = document.documentElement;
  root.classList.add("js");
  const kept = (value) => {
    try {
      if (value) localStorage.setItem("coopera-theme", value);
      return localStorage.getItem("coopera-theme");
    } catch { return null; }
  };
  if (kept()) root.dataset.theme = kept();
  document.addEventListener("DOMContentLoaded", () => {
    document.getElementById("theme")?.addEventListener("click", () => {
      const dark = root.dataset.theme ? root.dataset.theme === "dark" : matchMedia("(prefers-color-scheme: dark)").matches;
      root.dataset.theme = dark ? "light" : "dark";
      kept(root.dataset.theme);
    });
  });

  const meta = () => document.querySelector("meta[name=form-token]");
  const send = (address, data) => fetch(address, {
    method: "POST", credentials: "same-origin",
    headers: { "content-type": "application/json", accept: "application/json", "x-form-token": meta().content },
    body: JSON.stringify(data),
  });
  // Posts an object and gives back the answer's object; after a restart of the server it fetches the new form token once.
  const post = async (address, data) => {
    let answer = await send(address, data);
    if (answer.status === 403 && answer.headers.get("x-stale")) {
      meta().content = (await (await fetch("/form-token", { credentials: "same-origin" })).json()).form_token;
      answer = await send(address, data);
    }
    const text = await answer.text();
    let found;
    try { found = JSON.parse(text); } catch { found = { problem: text || answer.statusText }; }
    if (!answer.ok) throw Object.assign(new Error(found.problem || answer.statusText), { status: answer.status, answer: found });
    return found;
  };
  return { post };
})();
