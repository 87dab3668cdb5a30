/**
 * Pointer and keyboard of a plot. Drag: zoom into the stretch; Shift-drag or a finger: move; two fingers: pinch;
 * Ctrl-wheel (or wheel when the plot has the focus): zoom; double click: show all.
 */

const LEAST_DRAG_PX = 5;

export function attach(plot) {
  const { canvas } = plot;
  const pointers = new Map();
  let start = null;

  const at = (event) => {
    const box = canvas.getBoundingClientRect();
    return { x: event.clientX - box.left, y: event.clientY - box.top };
  };
  const inside = (point) => plot.box && point.x >= plot.box.left && point.x <= plot.box.right;

  function hover(point) {
    plot.cursor = point && inside(point) ? point : null;
    plot.showTip(point ? plot.options.hover?.(point) ?? null : null, point);
    plot.redraw();
  }

  canvas.addEventListener("pointerdown", (event) => {
    if (event.button !== 0 || !plot.x) return;
    pointers.set(event.pointerId, at(event));
    canvas.setPointerCapture(event.pointerId);
    const touch = event.pointerType === "touch";
    start = { point: at(event), view: [...plot.view], pan: touch || event.shiftKey, spread: spread(pointers) };
  });
  canvas.addEventListener("pointermove", (event) => {
    const point = at(event);
    if (!pointers.has(event.pointerId)) { hover(point); return; }
    pointers.set(event.pointerId, point);
    if (pointers.size === 2) pinch();
    else if (start.pan) move(point);
    else {
      plot.selection = Math.abs(point.x - start.point.x) > LEAST_DRAG_PX ? [start.point.x, point.x] : null;
      plot.redraw();
    }
  });

  function move(point) {
    const perPx = (start.view[1] - start.view[0]) / (plot.box.right - plot.box.left);
    const shift = (start.point.x - point.x) * perPx;
    plot.setView(start.view[0] + shift, start.view[1] + shift);
  }

  function pinch() {
    const now = spread(pointers);
    const factor = start.spread / Math.max(now, 10);
    const middle = (start.view[0] + start.view[1]) / 2;
    const half = ((start.view[1] - start.view[0]) / 2) * factor;
    plot.setView(middle - half, middle + half);
  }

  function release(event) {
    if (!pointers.delete(event.pointerId)) return;
    const chosen = plot.selection;
    plot.selection = null;
    if (chosen) {
      const [a, b] = chosen.map((px) => plot.x.value(px)).sort((p, q) => p - q);
      plot.setView(a, b);
    } else if (start && Math.abs(at(event).x - start.point.x) <= LEAST_DRAG_PX) {
      plot.options.onPick?.(at(event));
      plot.redraw();
    }
    start = pointers.size ? { ...start, view: [...plot.view], point: [...pointers.values()][0] } : null;
  }
  canvas.addEventListener("pointerup", release);
  canvas.addEventListener("pointercancel", release);
  canvas.addEventListener("pointerleave", () => hover(null));
  canvas.addEventListener("dblclick", () => plot.reset());
  canvas.addEventListener("wheel", (event) => {
    if (!event.ctrlKey && !event.metaKey && document.activeElement !== canvas) return;
    event.preventDefault();
    plot.zoom(Math.exp(Math.max(-60, Math.min(60, event.deltaY)) / 200), plot.x.value(at(event).x));
  }, { passive: false });
  canvas.addEventListener("keydown", (event) => {
    const action = KEYS[event.key];
    if (!action || event.ctrlKey || event.altKey || event.metaKey) return;
    event.preventDefault();
    action(plot);
  });
}

const KEYS = {
  ArrowLeft: (plot) => plot.pan(-0.1),
  ArrowRight: (plot) => plot.pan(0.1),
  "+": (plot) => plot.zoom(0.7),
  "=": (plot) => plot.zoom(0.7),
  "-": (plot) => plot.zoom(1 / 0.7),
  0: (plot) => plot.reset(),
  Home: (plot) => plot.reset(),
};

function spread(pointers) {
  const [a, b] = [...pointers.values()];
  return a && b ? Math.abs(a.x - b.x) : 1;
}
