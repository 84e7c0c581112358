// Opening a pack checks its table and scene; here come the pages, and whether they and these are
// all that is in the file.
#include "apps/verify/verify_pack.h"

#include <fmt/format.h>

#include "apps/options/outputs.h"
#include "apps/statistics.h"
#include "apps/terminal/progress_bar.h"
#include "packs/check_pack.h"
#include "parallel/arena.h"

namespace delray::apps {

int verify_pack(Session& session, const VerifyOptions& options) {
  if (options.points.is_set() || !options.points.path.empty() || options.points.given() ||
      options.canonical || options.complete || options.dim != 2 || !options.scratch.empty()) {
    throw UsageError(fmt::format(
        "{} is a pack, which is checked by itself: --points and what goes with them are for "
        "triangulations",
        options.mesh));
  }
  if (options.launch.ranks > 1 || session.processes > 1)
    throw UsageError("several ranks are for triangulations; a pack is checked by threads");
  const int threads = threads_per_rank(options.launch, 1);
  const parallel::AllowThreads allowed(threads);
  parallel::Arena arena(threads);
  ProgressBar bar(session, "verify");
  const packs::PackReader pack(options.mesh, options.points.limits.budget());
  arena.execute([&] { packs::check_pack(pack, &session.progress); });
  bar.end();
  write_statistics(options.statistics, {{"schema", "delray.verify_pack/1"},
                                        {"pack", options.mesh},
                                        {"result",
                                         {{"pages", pack.pages().size()},
                                          {"groups", pack.groups().size()},
                                          {"bytes", pack.file_bytes()},
                                          {"valid", true}}}});
  if (options.statistics != "-") {
    fmt::print("valid: yes\nchecked: {}, {} bytes\n", count_text(pack.pages().size(), "page"),
               pack.file_bytes());
  }
  return kDone;
}

}  // namespace delray::apps
