// SPDX-License-Identifier: Apache-2.0
#include "host/report/style.h"

namespace rt {

// Colors after Okabe and Ito (2008), distinct to the color-blind; darkened on white and
// lightened on black until each has a contrast of 4.5 to 1 or, for lines, 3 to 1.
const char* const report_style = R"css(
:root {
  color-scheme: light dark;
  --paper: #fff; --ink: #1b1f24; --soft: #57606a; --rule: #d5dae0; --tint: #f5f7f9;
  --grid: #e3e7eb; --faint: #f0f2f4; --accent: #0b62a3; --floor: #8a939d33; --shade: #0004;
  --s0: #0068a8; --s1: #c04f00; --s2: #00805d; --s3: #a8407f;
  --s4: #746400; --s5: #5b4bb5; --s6: #333; --s7: #86503f;
}
@media (prefers-color-scheme: dark) {
  :root {
    --paper: #14171b; --ink: #e7eaee; --soft: #a3adb8; --rule: #363d46; --tint: #1c2127;
    --grid: #2b3139; --faint: #20252b; --accent: #79bdf2; --floor: #9aa5b133; --shade: #fff5;
    --s0: #5fb8f5; --s1: #ff9a55; --s2: #3ecb9d; --s3: #f29ac7;
    --s4: #e4d150; --s5: #ab9eff; --s6: #e8e8e8; --s7: #d8a898;
  }
}
@media print {
  :root {
    --paper: #fff; --ink: #000; --soft: #444; --rule: #bbb; --tint: #fff;
    --grid: #ddd; --faint: #eee; --accent: #000; --floor: #0002;
    --s0: #0068a8; --s1: #c04f00; --s2: #00805d; --s3: #a8407f;
    --s4: #746400; --s5: #5b4bb5; --s6: #333; --s7: #86503f;
  }
}
* { box-sizing: border-box; }
html { -webkit-text-size-adjust: 100%; scroll-behavior: smooth; }
body {
  margin: 0 auto; padding: 2.5rem 1.25rem 4rem; max-width: 62.5rem;
  background: var(--paper); color: var(--ink);
  font: 1rem/1.6 system-ui, -apple-system, "Segoe UI", "Helvetica Neue", "DejaVu Sans", sans-serif;
}
h1, h2, h3, h4 { line-height: 1.25; font-weight: 650; text-wrap: balance; }
h1 { font-size: 2.1rem; margin: 0 0 .5rem; letter-spacing: -.015em; }
h2 { font-size: 1.5rem; margin: 3.5rem 0 1rem; padding-top: 1rem; border-top: 2px solid var(--ink); }
h3 { font-size: 1.13rem; margin: 2.5rem 0 .5rem; }
p, li { max-width: 44rem; }
p { margin: .5rem 0 1rem; }
a { color: var(--accent); text-underline-offset: .15em; }
:focus-visible { outline: 2px solid var(--accent); outline-offset: 2px; }
.lead { font-size: 1.1rem; color: var(--soft); margin-top: 0; }
.warning { border-left: .3rem solid #c60; padding-left: .8rem; font-weight: 600; }
.glance dd { white-space: nowrap; } .glance dd small { white-space: normal; }
.note, figcaption, caption { color: var(--soft); font-size: .9rem; line-height: 1.5; }
nav ul { display: flex; flex-wrap: wrap; gap: .25rem 1.25rem; padding: 0; margin: 1.25rem 0 0; list-style: none; font-size: .95rem; }
code, pre { font: .85rem/1.55 ui-monospace, "SF Mono", Menlo, Consolas, "DejaVu Sans Mono", monospace; }
pre { background: var(--tint); border: 1px solid var(--rule); border-radius: 6px; padding: .8rem 1rem; overflow-x: auto; }
code { overflow-wrap: anywhere; }
pre code { overflow-wrap: normal; }
.glance { display: grid; grid-template-columns: repeat(auto-fit, minmax(9.5rem, 1fr)); gap: 0 1.75rem; margin: 1.5rem 0; }
.glance div { border-top: 1px solid var(--rule); padding: .7rem 0 1rem; }
.glance dt { color: var(--soft); font-size: .88rem; }
.glance dd { margin: .1rem 0 0; font-size: 1.65rem; font-weight: 600; line-height: 1.25; font-variant-numeric: tabular-nums; }
.glance dd small { display: block; font-size: .85rem; font-weight: 400; color: var(--soft); line-height: 1.45; }
figure { margin: 1.25rem 0 1.75rem; }
figure img { display: block; width: 100%; height: auto; background: #000; border-radius: 3px; }
figcaption { margin-top: .45rem; max-width: 44rem; }
.pictures { display: grid; gap: 0 1.25rem; grid-template-columns: repeat(2, minmax(0, 1fr)); align-items: start; }
.pictures.three { grid-template-columns: repeat(3, minmax(0, 1fr)); }
.pixels img { image-rendering: pixelated; }
.scale { display: flex; align-items: center; gap: .6rem; font-size: .85rem; color: var(--soft); margin: -.75rem 0 1.5rem; }
.scale img { height: .8rem; width: 14rem; max-width: 45vw; border-radius: 2px; image-rendering: auto; }
.picture { position: relative; }
.mark { position: absolute; inset: 0; width: 100%; height: 100%; }
.mark rect { fill: none; vector-effect: non-scaling-stroke; }
.mark .under { stroke: #000; stroke-width: 4; } .mark .over { stroke: #fff; stroke-width: 2; }
.plot { max-width: 38rem; }
.plot > svg { display: block; width: 100%; height: auto; }
.plots { display: grid; gap: 0 2rem; grid-template-columns: repeat(auto-fit, minmax(min(100%, 25rem), 1fr)); align-items: start; }
/* Shadows at the edges that hide something; what scrolls along covers them at the ends. */
.scroll {
  overflow-x: auto; background-repeat: no-repeat; background-attachment: local, local, scroll, scroll;
  background-image: linear-gradient(to right, var(--paper) 40%, transparent), linear-gradient(to left, var(--paper) 40%, transparent),
    linear-gradient(to right, var(--shade), transparent), linear-gradient(to left, var(--shade), transparent);
  background-position: left, right, left, right; background-size: 3rem calc(100% + 2px), 3rem calc(100% + 2px), 1.1rem 100%, 1.1rem 100%;
}
svg text { font: 12px system-ui, -apple-system, "Segoe UI", "DejaVu Sans", sans-serif; fill: var(--ink); font-variant-numeric: tabular-nums; }
svg .axes text { fill: var(--soft); }
svg text.name { fill: var(--ink); font-weight: 600; }
svg text.name-of-curve { fill: var(--c); font-weight: 600; }
svg text.strong { font-weight: 600; }
svg text.halo { paint-order: stroke; stroke: var(--paper); stroke-width: 4px; stroke-linejoin: round; }
.grid { stroke: var(--grid); } .grid.faint { stroke: var(--faint); } .edge { stroke: var(--soft); }
.line { fill: none; stroke: var(--c); stroke-width: 2; stroke-linejoin: round; }
.line.prediction { stroke-width: 1.5; stroke-dasharray: 2 4; stroke-linecap: round; }
.band { fill: var(--c); stroke: var(--c); stroke-width: 1; opacity: .2; }
.marker { fill: var(--c); stroke: var(--paper); stroke-width: 1.2; }
.hollow .line { stroke-width: 1; } .hollow .marker { fill: var(--paper); stroke: var(--c); } .hollow .band { display: none; }
.offset { fill: none; stroke: var(--c); stroke-width: 1.3; stroke-dasharray: 1.5 3; }
.front { fill: none; stroke: var(--ink); stroke-width: 5; opacity: .2; stroke-linejoin: round; }
.floor { fill: var(--floor); }
.s0 { --c: var(--s0); } .s1 { --c: var(--s1); } .s2 { --c: var(--s2); } .s3 { --c: var(--s3); }
.s4 { --c: var(--s4); } .s5 { --c: var(--s5); } .s6 { --c: var(--s6); } .s7 { --c: var(--s7); }
.d1 .line { stroke-dasharray: 7 3; } .d2 .line { stroke-dasharray: 2 2.5; }
.d3 .line { stroke-dasharray: 10 3 2 3; } .d4 .line { stroke-dasharray: 4 4; }
.d5 .line { stroke-dasharray: 12 4; } .d6 .line { stroke-dasharray: 1 3; }
.d7 .line { stroke-dasharray: 8 2 2 2 2 2; }
.bar { margin: 0 0 1.1rem; }
.bar p { margin: 0; }
.bar > svg { display: block; width: 100%; height: 1.25rem; }
.bar ul { display: flex; flex-wrap: wrap; gap: 0 1rem; margin: .15rem 0 0; padding: 0; list-style: none; font-size: .85rem; color: var(--soft); font-variant-numeric: tabular-nums; }
.box { width: .7em; height: .7em; margin-right: .35em; }
.part { fill: var(--c); stroke: var(--paper); stroke-width: 1; vector-effect: non-scaling-stroke; }
.p0, .p2, .p4 { fill-opacity: .25; } .p1, .p6 { fill-opacity: .5; } .p3 { fill-opacity: .7; } .p7 { fill-opacity: .35; }
td.drawn { position: relative; padding-left: 3.8rem; }
.share { position: absolute; left: 0; top: .75em; width: 3.4rem; height: .6rem; }
.share rect { fill: var(--soft); } .share .whole { fill: var(--rule); }
table { border-collapse: collapse; font-size: .92rem; font-variant-numeric: tabular-nums; margin: .75rem 0 1.25rem; }
caption { text-align: left; caption-side: top; padding-bottom: .5rem; }
th, td { padding: .34rem 1.1rem .34rem 0; text-align: left; vertical-align: baseline; border-bottom: 1px solid var(--rule); white-space: nowrap; }
.number { text-align: right; }
td.number[data-pad]::after { content: attr(data-pad); visibility: hidden; }
td.long { white-space: normal; min-width: 16rem; }
.facts td.long { min-width: 0; }
.dense table { font-size: .82rem; }
.dense th, .dense td { padding-right: .7rem; white-space: normal; }
.dense { margin-right: calc(-1 * min(8rem, max(0rem, (100vw - 62.5rem) / 2 - 1.5rem))); }
.dense th[scope=row], .dense td.number { white-space: nowrap; }
.dense td.words { white-space: normal; min-width: 5rem; }
.dense td.long { min-width: 12rem; }
.on-paper { display: none; }
h4 { font-size: 1rem; margin: 1.5rem 0 .5rem; }
th:last-child, td:last-child { padding-right: .1rem; }
thead th { font-weight: 600; border-bottom-color: var(--ink); white-space: normal; vertical-align: bottom; }
tbody th { font-weight: 400; }
.facts { max-width: 46rem; }
.facts th, .facts td, .facts td:last-child { text-align: left; white-space: normal; overflow-wrap: anywhere; }
.facts tbody th { color: var(--soft); white-space: nowrap; }
details summary { cursor: pointer; color: var(--accent); }
footer { margin-top: 3.5rem; padding-top: 1rem; border-top: 1px solid var(--rule); color: var(--soft); font-size: .9rem; }
@media (max-width: 40rem) {
  body { padding: 1.5rem 1rem 3rem; }
  h1 { font-size: 1.7rem; }
  .pictures, .pictures.three { gap: 0 .6rem; }
  .pictures.three { grid-template-columns: minmax(0, 1fr); }
  svg text { font-size: 14px; }
  table { font-size: .8rem; }
  th, td { padding-right: .5rem; white-space: normal; }
}
@media print {
  @page { margin: 13mm 12mm; }
  body { padding: 0; max-width: none; font-size: 9pt; line-height: 1.4; }
  nav, details { display: none; }
  .on-paper { display: block; }
  h1 { font-size: 16pt; }
  h2 { margin-top: 1.2rem; font-size: 13pt; }
  h3 { margin: 1rem 0 .3rem; }
  h2, h3, h4, caption, h3 + p { break-after: avoid; }
  p { margin: .25rem 0 .5rem; }
  figcaption, .note, caption { font-size: 8pt; }
  figure { margin: .4rem 0 .5rem; }
  figure, table, tr, .glance div, .bar, pre { break-inside: avoid; }
  .scale { margin: .2rem 0 .6rem; }
  .glance { grid-template-columns: repeat(5, 1fr); gap: 0 1rem; margin: .7rem 0; }
  .glance dd { font-size: 1.2rem; }
  .glance dd small, .bar ul, .scale { font-size: 8pt; }
  .lead { font-size: 10pt; }
  .pictures { break-inside: avoid; max-width: 116mm; }
  .pictures.three { max-width: 96mm; grid-template-columns: repeat(3, minmax(0, 1fr)); }
  .plots { grid-template-columns: 1fr 1fr; }
  .plot { max-width: 105mm; }
  .bars { columns: 2; column-gap: 8mm; } .bar { margin: 0 0 .6rem; }
  .bars + figcaption { max-width: none; }
  figure:has(.bars) { max-width: none; }
  table { font-size: 8pt; margin: .3rem 0 .6rem; }
  th, td { padding-top: .12rem; padding-bottom: .12rem; }
  .dense { margin-right: 0; }
  .dense table { font-size: 6.5pt; }
  .dense td.long { min-width: 38mm; } .dense td.words { min-width: 0; }
  td.drawn { padding-left: 2rem; } .share { width: 1.7rem; top: .4em; }
  .dense th, .dense td { padding-right: .4rem; }
  pre { white-space: pre-wrap; overflow-wrap: anywhere; font-size: 7pt; }
  .scroll { overflow: visible; background: none; }
  * { print-color-adjust: exact; -webkit-print-color-adjust: exact; }
}
)css";

}  // namespace rt
