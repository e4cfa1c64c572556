// SPDX-License-Identifier: Apache-2.0
#include "host/report/style.h"

namespace rt {

// Colors after Okabe and Ito (2008), told apart by the color-blind; darkened on white and
// lightened on black until each has a contrast of 4.5 to 1 or, for lines, 3 to 1.
const char* const report_style = R"css(
:root {
  color-scheme: light dark;
  --paper: #fff; --ink: #1b1f24; --soft: #57606a; --rule: #d5dae0; --tint: #f5f7f9;
  --grid: #e3e7eb; --faint: #f0f2f4; --accent: #0b62a3; --floor: #8a939d33;
  --s0: #0068a8; --s1: #c04f00; --s2: #00805d; --s3: #a8407f;
  --s4: #746400; --s5: #5b4bb5; --s6: #333; --s7: #86503f;
  --p0: #b9c2cc; --p1: #8f9aa6; --p2: #7a5195; --p3: #d9822b; --p4: #46a08a;
  --p5: #2470ac; --p6: #c46a9c; --p7: #6d7a2e;
}
@media (prefers-color-scheme: dark) {
  :root {
    --paper: #14171b; --ink: #e7eaee; --soft: #a3adb8; --rule: #363d46; --tint: #1c2127;
    --grid: #2b3139; --faint: #20252b; --accent: #79bdf2; --floor: #9aa5b133;
    --s0: #5fb8f5; --s1: #ff9a55; --s2: #3ecb9d; --s3: #f29ac7;
    --s4: #e4d150; --s5: #ab9eff; --s6: #e8e8e8; --s7: #d8a898;
    --p0: #5b6670; --p1: #7d8995; --p2: #a884c4; --p3: #e3964a; --p4: #5bbfa6;
    --p5: #62b0ec; --p6: #dc8bb8; --p7: #a8b752;
  }
}
@media print {
  :root {
    --paper: #fff; --ink: #000; --soft: #444; --rule: #bbb; --tint: #fff;
    --grid: #ddd; --faint: #eee; --accent: #000; --floor: #0002;
    --s0: #0068a8; --s1: #c04f00; --s2: #00805d; --s3: #a8407f;
    --s4: #746400; --s5: #5b4bb5; --s6: #333; --s7: #86503f;
    --p0: #b9c2cc; --p1: #8f9aa6; --p2: #7a5195; --p3: #d9822b; --p4: #46a08a;
    --p5: #2470ac; --p6: #c46a9c; --p7: #6d7a2e;
  }
}
* { box-sizing: border-box; }
html { -webkit-text-size-adjust: 100%; scroll-behavior: smooth; }
body {
  margin: 0 auto; padding: 2.5rem 1.25rem 4rem; max-width: 62.5rem;
  background: var(--paper); color: var(--ink);
  font: 1rem/1.6 system-ui, -apple-system, "Segoe UI", "Helvetica Neue", "DejaVu Sans", sans-serif;
}
h1, h2, h3 { line-height: 1.25; font-weight: 650; text-wrap: balance; }
h1 { font-size: 2.1rem; margin: 0 0 .5rem; letter-spacing: -.015em; }
h2 { font-size: 1.5rem; margin: 3.5rem 0 1rem; padding-top: 1rem; border-top: 2px solid var(--ink); }
h3 { font-size: 1.13rem; margin: 2.5rem 0 .5rem; }
p, li { max-width: 44rem; }
p { margin: .5rem 0 1rem; }
a { color: var(--accent); text-underline-offset: .15em; }
:focus-visible { outline: 2px solid var(--accent); outline-offset: 2px; }
.lead { font-size: 1.1rem; color: var(--soft); margin-top: 0; }
.warning { border-left: .3rem solid #c60; padding-left: .8rem; font-weight: 600; }
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
.plot { max-width: 46rem; }
.plot > .scroll { padding-bottom: 0; }
.plot .scroll > svg { display: block; width: 100%; min-width: 30rem; height: auto; }
.scroll { overflow-x: auto; }
svg text { font: 13.5px system-ui, -apple-system, "Segoe UI", "DejaVu Sans", sans-serif; fill: var(--ink); font-variant-numeric: tabular-nums; }
svg .axes text { fill: var(--soft); }
svg text.name { fill: var(--ink); font-weight: 600; }
svg text.small { font-size: 12px; }
svg text.strong { font-weight: 600; }
svg text.halo { paint-order: stroke; stroke: var(--paper); stroke-width: 4px; stroke-linejoin: round; }
.grid { stroke: var(--grid); } .grid.faint { stroke: var(--faint); } .edge { stroke: var(--soft); }
.line { fill: none; stroke: var(--c); stroke-width: 2; stroke-linejoin: round; }
.line.prediction { stroke-width: 1.5; stroke-dasharray: 2 4; stroke-linecap: round; }
.band { fill: var(--c); stroke: var(--c); stroke-width: 1; opacity: .2; }
.marker { fill: var(--c); stroke: var(--paper); stroke-width: 1.2; }
.offset { fill: none; stroke: var(--c); stroke-width: 1.3; stroke-dasharray: 1.5 3; }
.front { fill: none; stroke: var(--ink); stroke-width: 5; opacity: .2; stroke-linejoin: round; }
.floor { fill: var(--floor); }
.s0 { --c: var(--s0); } .s1 { --c: var(--s1); } .s2 { --c: var(--s2); } .s3 { --c: var(--s3); }
.s4 { --c: var(--s4); } .s5 { --c: var(--s5); } .s6 { --c: var(--s6); } .s7 { --c: var(--s7); }
.d1 .line { stroke-dasharray: 7 3; } .d2 .line { stroke-dasharray: 2 2.5; }
.d3 .line { stroke-dasharray: 10 3 2 3; } .d4 .line { stroke-dasharray: 4 4; }
.d5 .line { stroke-dasharray: 12 4; } .d6 .line { stroke-dasharray: 1 3; }
.d7 .line { stroke-dasharray: 8 2 2 2 2 2; }
.p0 { fill: var(--p0); } .p1 { fill: var(--p1); } .p2 { fill: var(--p2); } .p3 { fill: var(--p3); }
.p4 { fill: var(--p4); } .p5 { fill: var(--p5); } .p6 { fill: var(--p6); } .p7 { fill: var(--p7); }
.part { stroke: var(--paper); stroke-width: 1; }
svg text.on-part { fill: #000; }
svg text.on-p2, svg text.on-p5, svg text.on-p7 { fill: var(--paper); }
.legend { display: flex; flex-wrap: wrap; gap: .15rem 1.4rem; list-style: none; padding: 0; margin: .5rem 0; font-size: .9rem; }
.legend svg { width: 34px; height: 14px; vertical-align: -2px; margin-right: .25rem; }
.legend svg.box { width: 14px; }
table { border-collapse: collapse; font-size: .92rem; font-variant-numeric: tabular-nums; margin: .75rem 0 1.25rem; }
caption { text-align: left; caption-side: top; padding-bottom: .5rem; }
th, td { padding: .34rem .9rem .34rem 0; text-align: right; vertical-align: baseline; border-bottom: 1px solid var(--rule); white-space: nowrap; }
th:first-child, td:first-child { text-align: left; }
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
}
@media print {
  @page { margin: 16mm 14mm; }
  body { padding: 0; max-width: none; font-size: 10pt; }
  nav { display: none; }
  h2 { margin-top: 2rem; }
  h2, h3, caption { break-after: avoid; }
  figure, tr, .glance div, pre { break-inside: avoid; }
  .pictures { break-inside: avoid; }
  pre { white-space: pre-wrap; overflow-wrap: anywhere; }
  .scroll { overflow: visible; }
  .plot { max-width: 120mm; }
  .plot .scroll > svg { min-width: 0; }
  * { print-color-adjust: exact; -webkit-print-color-adjust: exact; }
}
)css";

}  // namespace rt
