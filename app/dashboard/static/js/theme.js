// Runs before the page is painted, so that a stored choice of theme does not flash.
(function () {
  let chosen = null;
  try { chosen = localStorage.getItem("sideband-theme"); } catch { /* storage may be forbidden */ }
  if (chosen === "light" || chosen === "dark") document.documentElement.dataset.theme = chosen;
})();
