/** Sending a recording in: its description and its file. */

import { request } from "/js/lib/api.js";
import { h, replace } from "/js/lib/dom.js";
import { problemBox, toast } from "/js/lib/problem.js";

const EXAMPLE = JSON.stringify({
  sampling_rate_hz: 20000,
  channels: [{ name: "a", column: "a", quantity: "acceleration", unit: "m/s^2", location: "bearing1", axis: "y" }],
  operating: { shaft: "input", speed_hz: 25 },
  condition: "unknown",
}, null, 1);

const NAMES = { channels: "Channels", file: "Data", description: "Description" };

/** `sent()` is called after every recording that was taken. */
export function uploadCard(sent) {
  const description = h("textarea", { id: "upload-description", rows: "9", spellcheck: "false", value: EXAMPLE });
  const fromFile = h("input", { type: "file", id: "upload-description-file", accept: ".json,application/json", onchange: async () => {
    if (fromFile.files[0]) description.value = await fromFile.files[0].text();
  } });
  const data = h("input", { type: "file", id: "upload-file", required: true });
  const notice = h("div");
  const button = h("button", { type: "submit", class: "button" }, "Send recording");

  async function send(event) {
    event.preventDefault();
    replace(notice);
    const form = new FormData();
    form.append("description", description.value);
    form.append("file", data.files[0]);
    button.disabled = true;
    try {
      const taken = await (await request("/v1/recordings", { method: "POST", form })).json();
      toast(taken.created ? "The recording was taken and is being read." : "This recording was here already.");
      data.value = "";
      sent();
    } catch (error) {
      replace(notice, problemBox(error, NAMES));
    } finally {
      button.disabled = false;
    }
  }

  return h("section", { class: "card", "aria-label": "Send a recording" },
    h("div", { class: "card-head" }, h("h2", {}, "1. Send recordings")),
    h("form", { class: "card-body reconcile-form", onsubmit: send },
      h("label", { for: "upload-file" }, "Data (csv, npz, mat, wav, flac, parquet, hdf5, UFF 58, TDMS, MDF4)"), data,
      h("label", { for: "upload-description-file" }, "Description from a file, or written below"), fromFile,
      h("label", { for: "upload-description", class: "visually-hidden" }, "Description, JSON"), description,
      notice, h("div", {}, button)));
}
