"""Style of the page: light and dark by the reader's setting, readable in print."""

STYLE = """
:root { color-scheme: light dark; --bg:#f3f5f8; --surface:#fff; --text:#17212e; --muted:#566375;
 --border:#dbe1e9;
 --accent:#0f6fc6; --soft:#e3f0fc; --ok:#14804a; --ok-soft:#e0f4e9; --warn:#8a5a00; --warn-soft:#fdf1d8;
 --bad:#b3261e;
 --bad-soft:#fdeae8; --grid:#e6eaf0; --observed:#17212e; --before:#d2451e; --after:#0f6fc6; --part:#cfd8e3;
 --own:#7a35b8; }
@media (prefers-color-scheme: dark) { :root { --bg:#0d131b; --surface:#151d28; --text:#e6ecf3; --muted:#9dabbc;
 --border:#263242; --accent:#4aa3f0; --soft:#16304a; --ok:#4fcf8b; --ok-soft:#12301f; --warn:#e7b54a;
 --warn-soft:#33280f;
 --bad:#ff8a80; --bad-soft:#3a1a18; --grid:#212c3a; --observed:#e6ecf3; --before:#ff8358; --after:#57aef5;
 --part:#34445a; --own:#c79bff; } }
* { box-sizing:border-box } body { margin:0; background:var(--bg); color:var(--text);
 font:15px/1.55 "Inter","Segoe UI",system-ui,-apple-system,"Noto Sans","DejaVu Sans",sans-serif; }
main { max-width:1000px; margin:0 auto; padding:24px 20px 60px; display:grid; gap:16px; }
h1 { font-size:23px; line-height:1.3; margin:8px 0 4px; } h2 { font-size:16px; margin:0 0 10px; } h3 {
 font-size:14px; margin:14px 0 4px; }
p { margin:0 0 8px; } section, header { background:var(--surface); border:1px solid var(--border);
 border-radius:10px;
 padding:16px 20px; min-width:0; } .muted { color:var(--muted); font-size:13.5px; }
.badge { display:inline-block; border-radius:99px; padding:2px 12px; font-weight:650; font-size:13px;
 background:var(--soft); color:var(--accent); }
.badge.ok { background:var(--ok-soft); color:var(--ok); } .badge.warn { background:var(--warn-soft);
 color:var(--warn); }
.badge.bad { background:var(--bad-soft); color:var(--bad); }
.tiles { display:grid; grid-template-columns:repeat(auto-fit,minmax(165px,1fr)); gap:10px; margin-top:10px; }
.tile { border:1px solid var(--border); border-radius:8px; padding:9px 12px; } .tile b { display:block;
 font-size:19px; }
.tile span { color:var(--muted); font-size:13px; }
.scroll { overflow-x:auto; } table { border-collapse:collapse; width:100%; font-size:13.5px;
 font-variant-numeric:tabular-nums; }
th,td { text-align:left; padding:5px 10px 5px 0; border-bottom:1px solid var(--border); vertical-align:top; }
th { color:var(--muted); font-weight:600; } td.num,th.num { text-align:right; padding-right:18px; }
tr.named td { font-weight:650; } ul { margin:4px 0; padding-left:20px; }
svg.plot { width:100%; height:auto; display:block; } svg text { fill:var(--text); font-size:12px; }
svg .tick { fill:var(--muted); font-size:11px; } svg .label { fill:var(--muted); } .mid { text-anchor:middle }
 .end { text-anchor:end }
.grid { stroke:var(--grid); stroke-width:1 } .zero { stroke:var(--muted); stroke-width:1; stroke-dasharray:3 3 }
.curve { fill:none; stroke-width:1.4; stroke-linejoin:round } .observed { stroke:var(--observed); }
.before { stroke:var(--before); stroke-dasharray:5 3 } .after { stroke:var(--after) }
.band { fill:var(--muted); opacity:.22; } .mark { stroke-width:2.5 } .mark.up { stroke:var(--bad) } .mark.down
 { stroke:var(--ok) }
svg .mark-name.up { fill:var(--bad) } svg .mark-name.down { fill:var(--ok) }
.interval { stroke-width:3; stroke:var(--muted); opacity:.6 } .interval.named { stroke:var(--accent);
 opacity:1 }
.interval.null { stroke-width:12; opacity:.25 } .dot { fill:var(--surface); stroke:var(--muted);
 stroke-width:2 }
.dot.named { fill:var(--accent); stroke:var(--accent) } .observed-dot { fill:var(--observed); stroke:none }
.fitted { stroke:var(--after); stroke-width:3 } svg .row-name.named { font-weight:650 } .window {
 fill:var(--bad) }
.shaft { stroke:var(--muted); stroke-width:6; stroke-linecap:round; opacity:.55 } svg .shaft-name {
 fill:var(--muted); font-size:11px }
.part { fill:var(--part); stroke:var(--muted); stroke-width:1.2 } .ball { fill:var(--surface) } .spring {
 fill:none; stroke:var(--muted); stroke-width:1.5 }
.mesh { stroke:var(--muted); stroke-width:2; stroke-dasharray:4 4 } .located-mesh { stroke:var(--bad);
 stroke-width:4 }
.located { fill:none; stroke:var(--bad); stroke-width:3 } svg .located-share { fill:var(--bad);
 font-weight:650 }
.key { display:inline-flex; gap:16px; flex-wrap:wrap; color:var(--muted); font-size:13px; margin:2px 0 4px; }
.key i { display:inline-block; width:22px; border-top:2.5px solid; margin-right:6px; vertical-align:middle; }
.key .k-observed { border-color:var(--observed) } .key .k-before { border-color:var(--before);
 border-top-style:dashed } .key .k-after { border-color:var(--after) }
.key .k-band { border-color:var(--muted); border-top-width:10px; opacity:.35 }
.comb { stroke:var(--muted); stroke-width:1; stroke-dasharray:2 4; opacity:.7 }
.comb.own, .mark.side { stroke:var(--own) }
svg .comb-name.own { fill:var(--own); font-weight:650 }
code, pre { font-family:ui-monospace,"DejaVu Sans Mono",monospace; font-size:12.5px; } pre { overflow:auto;
 max-height:420px; margin:8px 0 0; }
.note { border-left:3px solid var(--warn); padding-left:10px; } .forms { color:var(--muted); font-weight:400; }
.bar.off, .bar.rival { fill:var(--muted); opacity:.55 } .bar.on { fill:var(--accent) }
svg .said { paint-order:stroke; stroke:var(--surface); stroke-width:5px }
.spread { stroke:var(--accent); stroke-width:3; opacity:.55 } .spread.open { stroke:var(--muted);
 stroke-dasharray:3 3; stroke-width:1.5 } .dot.told { fill:var(--accent); stroke:var(--accent) }
.key .k-told { border-color:var(--accent); border-top-width:6px } .key .k-open { border-color:var(--muted);
 border-top-style:dashed }
.whisker { stroke:var(--text); stroke-width:1.5 } .ceiling { stroke:var(--ok); stroke-width:2; stroke-dasharray:6 3 }
svg .ceiling-name { fill:var(--ok); font-weight:650 } details.point { border-top:1px solid var(--border);
 padding:8px 0; }
summary { cursor:pointer; font-weight:600 }
h1, p, li { overflow-wrap:anywhere } td { overflow-wrap:break-word }
sub { font-size:75%; line-height:0 } svg.plot.narrow { display:none } svg.plot.slim { max-width:460px; margin:0 auto }
@media (max-width:720px) { main { padding:10px 8px 40px } section, header { padding:12px }
 .sideways { overflow-x:auto } svg.plot { min-width:600px } svg.plot.wide { display:none }
 .figure::before { content:"⟷ wider than the screen: swipe sideways"; display:block; color:var(--muted);
  font-size:12.5px }
 svg.plot.narrow { display:block } svg.plot.narrow, svg.plot.slim { min-width:0 }
 .scroll tbody, .scroll tr, .scroll td { display:block; border:0; padding:1px 0; overflow-wrap:anywhere }
 .scroll tr { border-bottom:1px solid var(--border); padding:6px 0 } .scroll tr.heads { display:none }
 .scroll td:empty { display:none }
 .scroll td[data-head]:not(:first-child)::before { content:attr(data-head) ": "; color:var(--muted);
  font-weight:400 } }
@media print { body { background:#fff } section, header { break-inside:avoid; border-color:#bbb } pre {
 max-height:none } }
"""
