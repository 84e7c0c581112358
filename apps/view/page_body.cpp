// What is on the page.
#include "apps/view/page.h"

namespace delray::apps::view::internal {

const char* const kBody = R"html(<body>
<div id="stage">
<canvas id="picture" tabindex="0" role="img" aria-label="The scene: drag to turn it"></canvas>
<svg id="overlay" aria-hidden="true"></svg>
<div id="bar" role="toolbar" aria-label="View">
<button type="button" id="fit" title="Show everything (Home)">Fit</button>
<select id="views" aria-label="View from" title="Show everything from a side"></select>
<button type="button" id="fly" aria-pressed="false" title="Look around where you are; W A S D Q E move (F)">Fly</button>
<button type="button" id="measure" aria-pressed="false" title="Distance between two places that you click (M)">Measure</button>
<button type="button" id="clip" aria-pressed="false" title="Cut through the scene where you clicked last, or where it turns about (C)">Clip</button>
<button type="button" id="ranks" aria-pressed="false" title="Who renders what, and how long it takes (R)">Ranks</button>
<span class="gap"></span>
<button type="button" id="save" title="Save the picture as PNG">Save</button>
<button type="button" id="copy" title="Copy the command line that makes this picture">Copy command</button>
<button type="button" id="help" aria-pressed="false" title="Mouse and keys (?)">Help</button>
<button type="button" id="options" aria-pressed="true" aria-controls="panel" title="Options (O)">Options</button>
</div>
<div id="waiting"><p id="waitingtext">Connecting</p><progress id="progress"></progress></div>
<div id="note" role="alert"></div>
<div id="keys" hidden><h3>Mouse, fingers, keys</h3><dl>
<dt>drag, one finger</dt><dd>turn</dd>
<dt>right or shift + drag, two fingers</dt><dd>move</dd>
<dt>wheel, pinch</dt><dd>zoom to the pointer</dd>
<dt>click</dt><dd>what is there</dd>
<dt>double click</dt><dd>turn about that place</dd>
<dt>arrows, + and &minus;</dt><dd>turn, zoom; with shift move</dd>
<dt>W A S D, Q E</dt><dd>fly: forward, left, back, right, down, up</dd>
<dt>[ and ]</dt><dd>move the clipping plane</dd>
<dt>Home, F, M, C, R, O, ?</dt><dd>show all, fly, measure, clip, ranks, options, this</dd>
</dl></div>
<label id="cut" hidden>Clip <input type="range" id="cutat" min="0" max="1000" title="Where the cut is, from the front of the scene to its back ([ and ])"></label>
<div id="picked" hidden><button type="button" id="unpick" title="Close (Esc)">&times;</button><div id="facts"></div></div>
<div id="status" role="status"><span id="name"></span> <span id="numbers"></span> <span id="loading"></span></div>
</div>
<aside id="panel" aria-label="Options"><div id="figures" hidden></div><form id="groups"></form></aside>
)html";

}  // namespace delray::apps::view::internal
