/** Following a job: server-sent events over fetch (they must carry the API key), continued after a lost line. */

import { apiKey } from "/js/lib/api.js";

const RETRY_MS = 2000;

/** Calls `onEvent(kind, data)` for every event and `onEnd()` once the job has ended. Returns a function that stops. */
export function follow(path, onEvent, onEnd) {
  const abort = new AbortController();
  run(path, onEvent, abort.signal).then((ended) => { if (ended) onEnd(); });
  return () => abort.abort();
}

async function run(path, onEvent, signal) {
  let seen = "";
  while (!signal.aborted) {
    try {
      const ended = await read(path, seen, signal, (event) => {
        seen = event.id || seen;
        onEvent(event.kind, JSON.parse(event.data));
      });
      if (ended) return true;
    } catch (error) {
      if (signal.aborted) return false;
    }
    await new Promise((resolve) => setTimeout(resolve, RETRY_MS));
  }
  return false;
}

/** True when the server says that there is no more to come. */
async function read(path, seen, signal, onEvent) {
  const headers = { Accept: "text/event-stream" };
  if (seen) headers["Last-Event-ID"] = seen;
  if (apiKey()) headers.Authorization = `Bearer ${apiKey()}`;
  const reply = await fetch(path, { headers, signal, cache: "no-store" });
  if (reply.status === 204 || reply.status === 404 || reply.status === 410) return true;
  if (!reply.ok) return false;
  const reader = reply.body.pipeThrough(new TextDecoderStream()).getReader();
  let text = "";
  for (;;) {
    const { value, done } = await reader.read();
    if (done) return false;
    const blocks = (text + value).split("\n\n");
    text = blocks.pop();
    blocks.map(parse).filter((event) => event.data).forEach(onEvent);
  }
}

function parse(block) {
  const event = { id: "", kind: "message", data: "" };
  for (const line of block.split("\n")) {
    const [name, ...rest] = line.split(":");
    const value = rest.join(":").replace(/^ /, "");
    if (name === "id") event.id = value;
    else if (name === "event") event.kind = value;
    else if (name === "data") event.data += value;
  }
  return event;
}
