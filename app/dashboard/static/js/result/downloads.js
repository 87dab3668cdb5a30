/** Files of a result in the formats of the field. */

import { download, query } from "/js/lib/api.js";
import { h, icon, select } from "/js/lib/dom.js";
import { bytes, channelName } from "/js/lib/format.js";
import { problemBox } from "/js/lib/problem.js";

const FORMATS = [["npz", "NumPy .npz"], ["csv", "CSV"], ["parquet", "Parquet"], ["wav", "WAV, 32-bit float"], ["mat", "MATLAB .mat"]];

export function downloadsCard({ base, job, summary }, current) {
  const format = select(FORMATS, "npz", { "aria-label": "Format" });
  const which = select([["all", summary.channels.length === 1 ? "The one channel" : `All ${summary.channels.length} channels`], ["one", "Channel in view"]], "all", { "aria-label": "Channels" });
  const range = select([["all", "Whole record"], ["view", "Stretch in view"]], "all", { "aria-label": "Stretch" });
  const notice = h("div");
  const button = h("button", { type: "submit", class: "button primary" }, icon("download"), "Download");

  async function save(event) {
    event.preventDefault();
    notice.replaceChildren();
    const { channel, view } = current();
    const parameters = { format: format.value };
    if (which.value === "one") parameters.channel = channel.name;
    if (range.value === "view") [parameters.start_s, parameters.end_s] = view;
    button.disabled = true;
    try {
      await download(`${base}/signals?${query(parameters)}`, `signals-${job.id.slice(0, 12)}.${format.value}`);
    } catch (error) {
      notice.append(problemBox(error));
    } finally {
      button.disabled = false;
    }
  }

  const link = (path, name, text) => h("a", { href: path, onclick: (event) => {
    event.preventDefault();
    download(path, name).catch((error) => notice.append(problemBox(error)));
  } }, text);
  const files = Object.entries(summary.files ?? {}).map(([name, file]) => link(file.href, name, `${name} (${bytes(file.bytes)})`));
  const plots = summary.links?.plots ? ["signal", "spectrum"].map((name) => link(`${summary.links.plots}/${name}.svg`, `${name}.svg`, `${name}.svg`)) : [];
  return h("section", { class: "card", id: "card-downloads", "aria-label": "Downloads" },
    h("div", { class: "card-head" }, h("h2", {}, "Downloads")),
    h("div", { class: "card-body" }, notice,
      h("form", { class: "download-form", onsubmit: save }, format, which, range, button),
      h("p", { class: "notes" }, `Units are inside the files. ${summary.channels.map((c) => channelName(c.name)).slice(0, 4).join("; ")}${summary.channels.length > 4 ? " …" : ""}`),
      h("div", { class: "download-links" }, files, plots)));
}
