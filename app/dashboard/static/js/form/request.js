/** From the form to a request, and from an error's field back to the form. */

/** The request body. Effects of the preset that are switched off need the whole machine without them. */
export function buildRequest({ preset, machine, speed_hz, general, effects, channels }) {
  const set = {};
  if (machine.operating && speed_hz !== machine.operating.speed_hz) set["operating.speed_hz"] = speed_hz;
  const off = effects.filter((effect) => effect.preset && !effect.on());
  for (const effect of effects) if (effect.on()) Object.assign(set, effect.changes());
  const choice = off.length ? { machine: without(machine, off) } : { preset };
  return { ...choice, set, ...general, ...(channels ? { channels } : {}) };
}

function without(machine, effects) {
  return { ...machine, terms: machine.terms.filter((item) => !effects.some((e) => e.term.key === item.term && e.site === item.site)) };
}

/** Terms in the order in which the server numbers them: the machine's own, then added ones. */
function termOrder(machine, effects) {
  const off = effects.filter((effect) => effect.preset && !effect.on());
  const own = without(machine, off).terms.map((item) => [item.term, item.site]);
  const added = effects.filter((effect) => effect.on() && !own.some(([term, site]) => term === effect.term.key && site === effect.site));
  return [...own, ...added.map((effect) => [effect.term.key, effect.site])];
}

/** The field of the form that an error's `field` means, or null. */
export function fieldFor(name, { machine, effects, fields }) {
  const key = name.replace(/^set\./, "");
  if (key === "operating.speed_hz" || key === "speed_hz") return fields.speed ?? null;
  if (fields[key]) return fields[key];
  const byName = /^([^@]+)@([^.]+)\.(.+)$/.exec(key);
  const byPlace = /^(?:machine\.)?terms\.(\d+)\.parameters\.(.+)$/.exec(key);
  if (!byName && !byPlace) return null;
  const [term, site] = byName ? [byName[1], byName[2]] : termOrder(machine, effects)[Number(byPlace[1])] ?? [];
  const parameter = byName ? byName[3] : byPlace[2];
  const effect = effects.find((e) => e.term.key === term && e.site === site);
  return effect?.fields.find((field) => field.param.name === parameter) ?? null;
}
