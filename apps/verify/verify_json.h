// The statistics that `verify` writes.
#pragma once

#include "apps/statistics.h"
#include "apps/verify/verify_folder.h"

namespace delray::apps {

// `result` says what was checked; to it comes what was found: a delaunay::Verdict or PiecesVerdict.
template <class Verdict>
Json verify_json(const VerifyOptions& options, Json result, const Verdict& verdict) {
  result.update({{"valid", verdict.valid},
                 {"delaunay", verdict.delaunay},
                 {"canonical", verdict.canonical},
                 {"simplex", verdict.simplex ? Json(*verdict.simplex) : Json(nullptr)},
                 {"reason", verdict.reason}});
  return {{"schema", "delray.verify/1"},
          {"mesh", options.mesh},
          {"points", options.points.path},
          {"dim", options.dim},
          {"result", result}};
}

}  // namespace delray::apps
