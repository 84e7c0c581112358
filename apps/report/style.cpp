// The style sheet of every report, for white and black, telephones and paper.
#include "apps/report/style.h"

namespace delray::apps::report::internal {

// The colours of series can be told apart with any colour vision (Okabe and Ito 2008), darker on
// white.
const char* const kStyle = R"css(
:root{color-scheme:light dark;--paper:#fff;--ink:#1c2126;--soft:#5c6670;--line:#dfe3e8;
--panel:#f5f7f9;--accent:#0067b0;--warn:#9a4a00;
--c0:#005a9c;--c1:#c75100;--c2:#00856a;--c3:#a8477d;--c4:#4fabe0;--c5:#a87c00;--c6:#4b4b9e;--c7:#4a4f55;--weak:#a3abb3}
@media (prefers-color-scheme:dark){:root{--paper:#14181c;--ink:#e6eaee;--soft:#9aa5b0;--line:#2d343b;
--panel:#1c2227;--accent:#5cb3f0;--warn:#f0a35c;
--c0:#86c8fa;--c1:#f08a4b;--c2:#3cc9a7;--c3:#e08fbd;--c4:#2f86dd;--c5:#e6c04d;--c6:#a3a3f0;--c7:#b8bec4;--weak:#5f6973}}
*{box-sizing:border-box}
body{margin:0 auto;max-width:110rem;padding:1.2rem 1.4rem 3rem;background:var(--paper);color:var(--ink);
font:16px/1.5 system-ui,"Segoe UI","Liberation Sans",sans-serif}
h1{font-size:1.5rem;line-height:1.25;margin:.2rem 0 .8rem}
h2{font-size:1.15rem;margin:1.2rem 0 .6rem}
h3{font-size:1rem;margin:1.2rem 0 .4rem}
p{max-width:46rem}
.answer{border-left:4px solid var(--accent);background:var(--panel);padding:.6rem 1rem;margin-bottom:1rem}
.answer{display:flex;flex-wrap:wrap;gap:.3rem 2.5rem}
.answer>div{flex:1 1 min(26rem,100%);min-width:0}
.answer>div+div{flex:2 1 min(40rem,100%)}
.answer p{margin:.3rem 0}
.answer .table{max-height:none}
.answer th{background:var(--panel)}
.answer th,.answer td{padding:.2rem .5rem}
.answer td:not(.number){white-space:normal;min-width:8.5rem}
.answer strong{font-weight:650}
.machine{color:var(--soft);font-size:.88rem;margin:-.5rem 0 .7rem;max-width:none}
.unfinished{color:var(--warn);font-weight:600}
nav{display:flex;flex-wrap:wrap;gap:.3rem;border-bottom:1px solid var(--line);position:sticky;top:0;
background:var(--paper);padding-top:.3rem;z-index:1}
nav button{font:inherit;color:inherit;background:none;border:0;border-bottom:3px solid transparent;
padding:.4rem .8rem;cursor:pointer}
nav button[aria-selected=true]{border-color:var(--accent);font-weight:600}
#csv{margin-left:auto;border:1px solid var(--line);border-radius:4px;margin-bottom:.3rem}
button:focus-visible,[tabindex]:focus-visible{outline:2px solid var(--accent);outline-offset:1px}
section.hidden{display:none}
section>h2{position:absolute;left:-99rem}
.beside{display:grid;grid-template-columns:repeat(auto-fit,minmax(min(20rem,100%),1fr));gap:1rem}
.columns{grid-template-columns:repeat(auto-fit,minmax(min(27rem,100%),1fr));gap:1rem 1.6rem}
.columns>:only-child{max-width:62rem}
.columns>*{min-width:0}
.beside figure{margin:.4rem 0}
figure{margin:1rem 0;padding:0}
figcaption{font-weight:600;font-size:.95rem;margin-bottom:.3rem}
figure svg{display:block;width:100%;height:auto}
.picture img{max-width:100%;height:auto;border:1px solid var(--line);
background:repeating-conic-gradient(var(--panel) 0 25%,var(--line) 0 50%) 0 0/16px 16px}
.picture figcaption{font-weight:400;color:var(--soft)}
text{fill:var(--ink);font-size:12px}
text.tick{fill:var(--soft)}
.chart,.timeline{container-type:inline-size}
.plot{overflow:hidden}
.plot>svg{width:100%;overflow:visible}
.plot>svg svg{overflow:visible}
@container (max-width:28rem){.spare{display:none}}
.matrix text{font-size:14px}
.grid{stroke:var(--line)}
.frame{fill:none;stroke:var(--line)}
.c0{--own:var(--c0)}.c1{--own:var(--c1)}.c2{--own:var(--c2)}.c3{--own:var(--c3)}
.c4{--own:var(--c4)}.c5{--own:var(--c5)}.c6{--own:var(--c6)}.c7{--own:var(--c7)}
.hit,.line{fill:none;vector-effect:non-scaling-stroke}
.hit{stroke:transparent;stroke-width:14}
.line,.spread,.series .name{pointer-events:none}
.line{stroke:var(--own);stroke-width:2}
.spread{stroke:var(--own);stroke-width:1.5;opacity:.5}
.point{fill:var(--own);stroke:var(--own);stroke-width:1.5}
.series{cursor:pointer}
.name{fill:var(--own);paint-order:stroke;stroke:var(--paper);stroke-width:4px;
stroke-linejoin:round}
.d1 .line{stroke-dasharray:7 3}
.d2 .line{stroke-dasharray:7 2 2 2}
.d3 .line{stroke-dasharray:12 3}
.predicted .line{stroke-dasharray:2 4}
.predicted .point{fill:var(--paper)}
.weak:not(.on):not(.chosen){--own:var(--weak)}
.series.weak:not(.on):not(.chosen) .line{stroke-width:1}
.series.weak:not(.on):not(.chosen) .point{stroke-width:0;fill:var(--own);fill-opacity:.7}
.series.weak:not(.on):not(.chosen) .name,.series.weak:not(.on):not(.chosen) .spread{display:none}
.chart.lit .series:not(.on){opacity:.2}
.series.on .line{stroke-width:3.5}
.bar{fill:var(--c4)}.bar.emphasised{fill:var(--c1)}
text.value{paint-order:stroke;stroke:var(--paper);stroke-width:4px;stroke-linejoin:round}
.mark{stroke:var(--ink);stroke-width:1.5;stroke-dasharray:5 3}
.cell{fill:var(--c0)}
.span{stroke:none}
.span.idle{--own:var(--line)}
.backdrop{position:absolute}
.overlay rect{shape-rendering:crispEdges}.overlay svg{border:1px solid var(--line)}
.above{fill:#e66100;background:#e66100}.below{fill:#1a6fdf;background:#1a6fdf}
.amount{fill:#c01030}.group{fill-opacity:.6}
.overlay rect:hover{stroke:#fff;stroke-width:3}
.border{fill:none;stroke:#000;stroke-width:1.5;stroke-opacity:.75;pointer-events:none}
.legend i:not(.span){display:inline-block;width:.9em;height:.9em;margin-right:.4em;vertical-align:-.1em;
border:1px solid var(--line)}
.span{fill:var(--own)}
i.span{background:var(--own);display:inline-block;width:.9em;height:.9em;margin-right:.4em;vertical-align:-.1em}
.legend{display:flex;flex-wrap:wrap;gap:.1rem .9rem;margin-top:.3rem;font-size:.85rem}
.legend .group{display:flex;flex-wrap:wrap;gap:0 .2rem}
.key{font:inherit;color:var(--ink);background:none;border:0;border-radius:4px;padding:.15rem .3rem}
button.key{cursor:pointer}
button.key.weak:not(.on):not(.chosen){color:var(--soft)}
button.key.on{background:var(--panel)}
button.key.chosen{box-shadow:inset 0 -2px var(--own)}
.key svg{display:inline-block;width:24px;height:10px;margin-right:.4rem;overflow:visible}
.source{font-weight:400;font-size:.72rem;color:var(--soft);border:1px solid var(--line);border-radius:3px;
padding:0 .25rem;margin-left:.35rem;white-space:nowrap}
.table{overflow-x:auto;max-height:34rem;overflow-y:auto}
table{border-collapse:collapse;font-size:.88rem}
th,td{padding:.2rem .7rem;border-bottom:1px solid var(--line);text-align:left;white-space:nowrap}
th{position:sticky;top:0;background:var(--paper);cursor:pointer;vertical-align:bottom}
th .source{display:table;margin:.1rem 0 0}
.number{text-align:right;font-variant-numeric:tabular-nums}
th.number .source{margin-left:auto}
tr.emphasised{background:var(--panel);font-weight:600}
footer{margin-top:2rem;border-top:1px solid var(--line);font-size:.88rem}
dl{display:grid;grid-template-columns:max-content 1fr;gap:.15rem 1rem}
dt{color:var(--soft)}dd{margin:0;overflow-wrap:anywhere}
#tip{position:fixed;display:none;pointer-events:none;background:var(--ink);color:var(--paper);
font-size:.82rem;padding:.25rem .5rem;border-radius:4px;max-width:24rem;z-index:2}
@media(max-width:40rem){body{padding:.8rem .8rem 2rem}dl{grid-template-columns:1fr}dd{margin-bottom:.4rem}
.source{font-size:.75rem}.answer{padding:.5rem .7rem}}
@media print{html{font-size:12.5px}body{padding:0;font-size:1rem}nav,#tip{display:none}section.hidden{display:block}section>h2{position:static}
h2,h3,figcaption{break-after:avoid}.legend,.overlay,.picture,.cell{print-color-adjust:exact}
.table{max-height:none;overflow:visible}figure,tr{break-inside:avoid}
.answer{display:block}.beside{display:block}.beside figure{display:inline-block;width:32%;margin:.2rem 0;vertical-align:top}
.columns figure,.beside figure:first-child:nth-last-child(2),
.beside figure:first-child:nth-last-child(2)~figure{width:49%}
table{font-size:.65rem}th,td{padding:.1rem .25rem}th{white-space:normal}
.answer table{font-size:.8rem}.answer th,.answer td{padding:.1rem .3rem}
.table .source{font-size:.55rem;padding:0 .1rem}}
)css";

// As many as report::kLookMarks: disc, square, diamond, triangles, cross.
const char* const kMarks = R"svg(<svg class="backdrop" width="0" height="0"><defs>
<circle id="m0" r="3.5"/><path id="m1" d="M-3-3H3V3H-3Z"/><path id="m2" d="M0-4.5L4.5 0L0 4.5L-4.5 0Z"/>
<path id="m3" d="M0-4L4 3H-4Z"/><path id="m4" d="M0 4L4-3H-4Z"/>
<path id="m5" d="M-1-4H1V-1H4V1H1V4H-1V1H-4V-1H-1Z"/></defs></svg>
)svg";

}  // namespace delray::apps::report::internal
