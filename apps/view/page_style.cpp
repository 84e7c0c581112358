// The look of the page, on top of that of reports, whose colours and charts it shares.
#include "apps/view/page.h"

namespace delray::apps::view::internal {

const char* const kStyle = R"css(
html,body{height:100%}
body{display:flex;max-width:none;padding:0;margin:0;overflow:hidden;font-size:14px}
#stage{position:relative;flex:1 1 0;min-width:0;overflow:hidden;
background:repeating-conic-gradient(var(--panel) 0 25%,var(--line) 0 50%) 0 0/16px 16px}
#picture,#overlay{position:absolute;inset:0;width:100%;height:100%;display:block}
#picture{touch-action:none;cursor:grab;outline:none}
#picture:focus-visible{box-shadow:inset 0 0 0 2px var(--accent)}
#picture.dragged{cursor:grabbing}
#picture.picks{cursor:crosshair}
#overlay{pointer-events:none}
#bar{position:absolute;top:.5rem;left:.5rem;right:.5rem;display:flex;flex-wrap:wrap;gap:.3rem;pointer-events:none}
#bar>*{pointer-events:auto}
#bar .gap{flex:1;pointer-events:none}
#bar button,#bar select,#panel select,#panel input,#unpick{font:inherit;color:inherit;background:var(--paper);
border:1px solid var(--line);border-radius:4px;padding:.25rem .6rem;min-height:2rem;cursor:pointer}
#bar button:hover,#bar select:hover{border-color:var(--accent)}
#bar button[aria-pressed=true]{background:var(--accent);border-color:var(--accent);color:var(--paper)}
#status{position:absolute;left:.5rem;bottom:.5rem;background:var(--paper);border-radius:4px;padding:.15rem .6rem;
font-variant-numeric:tabular-nums;max-width:calc(100% - 1rem);opacity:.9;pointer-events:none}
#name{font-weight:600;overflow-wrap:anywhere}
#numbers{color:var(--soft)}
#loading{font-weight:600;color:var(--accent)}
#waiting{position:absolute;left:50%;top:50%;transform:translate(-50%,-50%);background:var(--paper);border-radius:6px;
padding:.8rem 1.2rem;text-align:center;min-width:13rem}
#waiting p{margin:0 0 .4rem}
#waiting progress{width:100%}
#waiting.hidden{display:none}
#note{position:absolute;left:50%;top:3.6rem;transform:translateX(-50%);background:var(--warn);color:#fff;border-radius:4px;
padding:.4rem .8rem;max-width:min(40rem,calc(100% - 1rem));display:none;overflow-wrap:anywhere}
#note.shown{display:block}
#note.good{background:var(--ink);color:var(--paper)}
#keys,#picked{position:absolute;right:.5rem;bottom:3.2rem;background:var(--paper);border:1px solid var(--line);border-radius:6px;
padding:.6rem .9rem;max-width:min(25rem,calc(100% - 1rem));max-height:calc(100% - 7rem);overflow:auto}
#cut{position:absolute;right:.5rem;bottom:.5rem;background:var(--paper);border-radius:4px;padding:.15rem .6rem;display:flex;
align-items:center;gap:.5rem;opacity:.9}
#cut input{width:min(14rem,30vw);accent-color:var(--accent)}
#cuthere{font:inherit;color:inherit;background:none;border:1px solid var(--line);border-radius:4px;margin-top:.5rem;
padding:.15rem .6rem;cursor:pointer}
#keys h3{margin:.1rem 0 .5rem}
#keys dl{margin:0;grid-template-columns:max-content 1fr}
#picked{padding-right:2.4rem}
#picked dl{margin:0;font-variant-numeric:tabular-nums}
#picked h3{margin:.6rem 0 .2rem}#picked h3:first-child{margin-top:0}
#picked .distance{font-weight:650;margin:.5rem 0 0}
#unpick{position:absolute;top:.3rem;right:.3rem;border:0;min-height:0;padding:.1rem .5rem;font-size:1.1rem}
#keys[hidden],#cut[hidden],#picked[hidden],#panel[hidden],#figures[hidden]{display:none}
#panel{flex:0 0 20rem;overflow-y:auto;border-left:1px solid var(--line);padding:.6rem .8rem 2rem;background:var(--paper)}
#panel.wide{flex-basis:34rem}
#panel details{border-bottom:1px solid var(--line);padding:.3rem 0}
#panel summary{font-weight:600;cursor:pointer;padding:.2rem 0}
#panel label{display:grid;grid-template-columns:7.5rem 1fr;align-items:center;gap:.5rem;margin:.25rem 0}
#panel label.idle{opacity:.5}
#panel select,#panel input[type=text]{min-width:0;width:100%;cursor:auto}
#panel input[type=checkbox]{justify-self:start;min-height:0;width:1.1rem;height:1.1rem}
#panel input:invalid,#panel input.wrong{border-color:var(--warn)}
#figures{border-bottom:1px solid var(--line);padding-bottom:.6rem;margin-bottom:.3rem}
#figures h2{font-size:1rem;margin:.2rem 0}
#figures p{margin:.2rem 0}
#figures figure{margin:.6rem 0}
#figures th,#figures td{padding:.15rem .3rem;font-size:.78rem;white-space:normal}
.marker{fill:none;stroke:#fff;stroke-width:2;paint-order:stroke}
.marker.dark{stroke:#000;stroke-width:4}
.ruler{stroke:#000;stroke-width:4}.ruler.light{stroke:#fff;stroke-width:2}
#overlay text{fill:#fff;font-size:13px;font-weight:600;paint-order:stroke;stroke:#000;stroke-width:4px;stroke-linejoin:round}
#overlay rect{stroke:#000;stroke-opacity:.7}
@media(max-width:46rem){body{flex-direction:column}
#panel,#panel.wide{flex:0 0 42%;border-left:0;border-top:1px solid var(--line)}
#bar .gap{display:none}#bar button,#bar select{padding:.25rem .45rem}
#cut{bottom:2.6rem}#keys,#picked{bottom:5.2rem;max-height:60%}#note{top:5.6rem}}
@media(pointer:coarse){#bar button,#bar select,#panel select,#panel input[type=text]{min-height:2.6rem}}
)css";

}  // namespace delray::apps::view::internal
