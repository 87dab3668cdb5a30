/** Words of the laws of force by the names that reports have for their coefficients. */

export const LAWS = {
  quadratic: "even stiffness",
  cubic: "cubic support, odd stiffness",
  quintic: "odd stiffness, fifth power",
  odd_square: "odd stiffness, square",
  odd_power: "odd stiffness",
  root: "square root",
  contact_above: "one-sided spring",
  contact_below: "one-sided spring",
  hertz_above: "one-sided Hertz contact",
  hertz_below: "one-sided Hertz contact",
  stops: "stops on both sides",
  dry_friction: "dry friction",
  drag: "quadratic damping",
  cubic_drag: "cubic damping",
  van_der_pol: "damping that grows with the swing",
};
/** Effects that are called by the words of their law, where one was found. */
const CALLED_BY_LAW = ["custom_force", "cubic_support"];
/** As the report's page and sentence call it. */
export const words = (text) =>
  text
    .replace(/_/g, " ")
    .replace("missing tooth", "broken tooth")
    .replace("fit clearance series", "fit clearance, elastic housing");

/** An effect in words: `fit clearance`; of a law of force that is no effect of its own the law's, `stops on both sides`. */
export function effectName({ term, severity }) {
  return (CALLED_BY_LAW.includes(term) && LAWS[severity?.name]) || words(term);
}

/** What its size is: `gap`; nothing where that says no more than the effect's name. */
export function sizeName({ term, severity }) {
  return LAWS[severity.name] || severity.name === term ? "" : words(severity.name);
}

/** A name of the list of reconciliations: `outer_spall`, or a law's, `stops`. */
export function listedName(term) {
  return LAWS[term] ?? words(term);
}
