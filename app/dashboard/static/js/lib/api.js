/** Calls of the HTTP API. Every failure becomes an ApiProblem, also when nothing answers. */

const KEY = "sideband-api-key";
const SUBMITTER = "sideband-submitter";

/** A problem document (RFC 9457), or what comes nearest when there is none. */
export class ApiProblem extends Error {
  constructor(document) {
    super(document.detail || document.title);
    this.document = document;
    this.status = document.status;
    this.errors = document.errors ?? [];
  }
}

function stored(store, name) {
  try { return store.getItem(name); } catch { return null; }
}

export function apiKey() {
  return stored(sessionStorage, KEY) ?? "";
}

/** The key is kept for this tab only. */
export function setApiKey(key) {
  try { sessionStorage.setItem(KEY, key); } catch { /* then it is asked for again */ }
}

/** A name of this browser, so that asking twice for the same is one request to withdraw. */
export function submitter() {
  let name = stored(localStorage, SUBMITTER);
  if (!name) {
    name = `browser-${Math.random().toString(36).slice(2, 10)}`;
    try { localStorage.setItem(SUBMITTER, name); } catch { /* a new name each time then */ }
  }
  return name;
}

function headers(extra) {
  const key = apiKey();
  return key ? { ...extra, Authorization: `Bearer ${key}` } : extra;
}

/** The raw reply; throws ApiProblem unless it is a 2xx. `body` goes as JSON, `form` as parts with files. */
export async function request(path, { method = "GET", body, form, signal, headers: extra = {} } = {}) {
  const init = { method, signal, headers: headers(extra), body: form };
  if (body !== undefined) {
    init.body = JSON.stringify(body);
    init.headers["Content-Type"] = "application/json";
  }
  let reply;
  try {
    reply = await fetch(path, init);
  } catch (error) {
    if (error.name === "AbortError") throw error;
    throw new ApiProblem({ title: "No answer", status: 0, detail: "The server does not answer." });
  }
  if (reply.ok) return reply;
  throw new ApiProblem(await problemOf(reply));
}

async function problemOf(reply) {
  try {
    const document = await reply.json();
    if (document && document.title) return document;
  } catch { /* not JSON */ }
  return { title: reply.statusText || "Error", status: reply.status, detail: `The server replied with status ${reply.status}.` };
}

export async function getJson(path, options) {
  return (await request(path, options)).json();
}

export function query(values) {
  const search = new URLSearchParams();
  for (const [name, value] of Object.entries(values)) {
    if (value !== undefined && value !== null && value !== "") [value].flat().forEach((item) => search.append(name, item));
  }
  return search.toString();
}

const kept = new Map();

/** Documents that do not change while the page is open: presets, terms. A failure is not kept. */
export function reference(path) {
  if (!kept.has(path)) {
    kept.set(path, getJson(path).catch((error) => { kept.delete(path); throw error; }));
  }
  return kept.get(path);
}

/** Save a file. A link cannot carry a key, so with one the bytes go through memory. */
export async function download(path, filename) {
  let href = path;
  if (apiKey()) href = URL.createObjectURL(await (await request(path)).blob());
  const link = document.createElement("a");
  link.href = href;
  link.download = filename;
  link.click();
  if (href !== path) setTimeout(() => URL.revokeObjectURL(href), 10_000);
}
