/** Start: theme, health in the top bar, and the page that the address names. */

import { ApiProblem, apiKey, getJson, setApiKey } from "/js/lib/api.js";
import { h, icon, replace } from "/js/lib/dom.js";
import { clearBanner, problemBox, showBanner } from "/js/lib/problem.js";
import { cataloguePage } from "/js/catalogue/page.js";
import { termPage } from "/js/catalogue/term-page.js";
import { apiPage } from "/js/api/page.js";
import { datasetsPage } from "/js/datasets/page.js";
import { datasetPage } from "/js/datasets/result.js";
import { formPage } from "/js/form/page.js";
import { machinesPage } from "/js/machines/list.js";
import { machinePage } from "/js/machines/page.js";
import { overviewPage } from "/js/overview/page.js";
import { reconcilePage } from "/js/reconcile/page.js";
import { reconciliationPage } from "/js/reconcile/result.js";
import { resultPage } from "/js/result/page.js";

const HEALTH_MS = 3000;
const ROUTES = [
  [/^\/?$/, "overview", overviewPage, "Jobs"],
  [/^\/new$/, "new", formPage, "New simulation"],
  [/^\/catalogue\/([a-z0-9_]+)\/page$/, "catalogue", termPage, "Effect"],
  [/^\/api$/, "api", apiPage, "API"],
  [/^\/catalogue(?:\/([a-z0-9_]+))?$/, "catalogue", cataloguePage, "Physical effects"],
  [/^\/datasets$/, "datasets", datasetsPage, "Datasets"],
  [/^\/datasets\/([A-Za-z0-9_-]+)$/, "datasets", datasetPage, "Dataset"],
  [/^\/reconcile$/, "reconcile", reconcilePage, "Reconcile"],
  [/^\/reconcile\/([A-Za-z0-9_-]+)$/, "reconcile", reconciliationPage, "Reconciliation"],
  [/^\/machines$/, "machines", machinesPage, "Machines"],
  [/^\/machines\/([A-Za-z0-9][A-Za-z0-9._-]*)$/, "machines", machinePage, "Machine"],
  [/^\/jobs\/([A-Za-z0-9_-]+)$/, "result", resultPage, "Result"],
];

let leave = () => {};
let health = null;

function route() {
  const [path, search = ""] = location.hash.replace(/^#/, "").split("?");
  const main = document.getElementById("main");
  leave();
  leave = () => {};
  for (const [pattern, name, page, title] of ROUTES) {
    const match = pattern.exec(path);
    if (!match) continue;
    document.title = `${title} – Sideband`;
    for (const link of document.querySelectorAll("[data-route]")) {
      if (link.dataset.route === name) link.setAttribute("aria-current", "page");
      else link.removeAttribute("aria-current");
    }
    replace(main);
    leave = page(main, { id: match[1], query: new URLSearchParams(search), health: () => health }) ?? (() => {});
    return;
  }
  replace(main, h("div", { class: "card empty" }, h("p", {}, "There is no such page. "), h("a", { href: "#/" }, "To the jobs")));
}

async function watchHealth() {
  if (!document.hidden) {
    try {
      health = await getJson("/v1/health");
      setPill(health.status, { ok: "ready", degraded: "degraded", away: "not ready" }[health.status] ?? health.status);
      clearBanner();
    } catch (error) {
      health = null;
      setPill("away", error.status === 401 ? "key needed" : "no answer");
      if (error.status === 401) askForKey();
      else showBanner(h("p", {}, `${error instanceof ApiProblem ? error.message : "The server does not answer."} Trying again.`));
    }
    document.dispatchEvent(new CustomEvent("health", { detail: health }));
  }
  setTimeout(watchHealth, HEALTH_MS);
}

function setPill(status, text) {
  const pill = document.getElementById("health-pill");
  pill.dataset.status = status;
  pill.lastElementChild.textContent = text;
  pill.setAttribute("aria-label", `Service health: ${text}`);
}

function askForKey() {
  if (document.getElementById("key-form")) return;
  const field = h("input", { type: "password", id: "key-field", autocomplete: "off", required: true, value: "" });
  const form = h("form", { id: "key-form", class: "key-form", onsubmit: (event) => {
    event.preventDefault();
    setApiKey(field.value.trim());
    clearBanner();
    route();
  } }, h("label", { for: "key-field" }, apiKey() ? "That key is not known. API key" : "This server asks for an API key"),
  field, h("button", { class: "button primary", type: "submit" }, "Use key"));
  showBanner(form);
}

function setUpTheme() {
  const button = document.getElementById("theme-button");
  const system = matchMedia("(prefers-color-scheme: dark)");
  const dark = () => (document.documentElement.dataset.theme ?? (system.matches ? "dark" : "light")) === "dark";
  const refresh = () => {
    replace(button, icon(dark() ? "sun" : "moon"));
    document.dispatchEvent(new Event("themechange"));
  };
  button.addEventListener("click", () => {
    document.documentElement.dataset.theme = dark() ? "light" : "dark";
    try { localStorage.setItem("sideband-theme", document.documentElement.dataset.theme); } catch { /* not kept then */ }
    refresh();
  });
  system.addEventListener("change", refresh);
  refresh();
}

window.addEventListener("hashchange", () => {
  route();
  window.scrollTo(0, 0);
  document.getElementById("main").focus({ preventScroll: true });
});
document.getElementById("skip").addEventListener("click", (event) => {
  event.preventDefault();
  document.getElementById("main").focus();
});
window.addEventListener("unhandledrejection", (event) => {
  if (event.reason?.name !== "AbortError") document.getElementById("toasts").append(problemBox(event.reason));
});
setUpTheme();
route();
watchHealth();
