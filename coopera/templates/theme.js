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
})();
