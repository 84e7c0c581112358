// delray compare compose: the command line.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>

#include "apps/compare/compare_commands.h"
#include "apps/compare/compose/compare_compose.h"
#include "apps/compare/compose/compose_figures.h"
#include "apps/compare/compose/compose_report.h"
#include "apps/families.h"
#include "apps/options/help.h"
#include "apps/options/list.h"
#include "apps/options/numbers.h"
#include "apps/options/scheme_option.h"
#include "comm/network.h"
#include "composite/codec.h"
#include "composite/metadata_only.h"
#include "composite/scheme.h"

namespace delray::apps {
namespace {

int list_for_compose() {
  list_schemes();
  list_codecs();
  list_networks();
  return kDone;
}

// The maximum number of messages of a simulation, where --ranks is not given.
constexpr std::uint64_t kMostMessages = 4'000'000, kMostMessagesQuick = 450'000;

void check_codecs(const CompareRequest& request, bool asked) {
  const bool simulates = asked && std::any_of(request.ranks.begin(), request.ranks.end(),
                                              [](int ranks) { return ranks > kMostMeasuredRanks; });
  for (const std::string& codec : request.codecs) {
    if (simulates && !composite::metadata_only_of(codec)) {
      throw UsageError(
          fmt::format("--codec {}: what it sends depends on what pixels show, so that more than {} "
                      "ranks cannot be simulated",
                      codec, kMostMeasuredRanks));
    }
  }
}

int run(Session& session, const CLI::App& command, CompareRequest request) {
  if (request.list) return list_for_compose();
  const bool asked = command.count("--ranks") > 0;
  check_codecs(request, asked);
  if (!asked) request.most_messages = request.quick ? kMostMessagesQuick : kMostMessages;
  return run_scene_comparison(
      session, command, request, [&](const Prepared& prepared, parallel::Progress& progress) {
        const auto comparison = std::make_shared<const ComposeComparison>(
            compare_compose(session, request, prepared, progress));
        return Found{
            compose_table(comparison->rows), compose_statistics(request, prepared, *comparison),
            comparison->unfinished,
            [&, comparison] { return compose_report(session, request, prepared, *comparison); }};
      });
}

}  // namespace

void add_compare_compose(CLI::App& compare, Session& session) {
  CLI::App* command =
      compare.add_subcommand("compose", "Compare compositing schemes: bytes, messages and times");
  const auto request = std::make_shared<CompareRequest>();
  request->ranks = {2, 3, 4, 8, 16, 64, 256, 1024, 4096};
  add_scene_comparison_options(*command, *request,
                               "(default: 2,3,4,8,16,64, and 256,1024,4096 for schemes that are "
                               "fast to simulate); more than "
                               "64 are simulated");
  command->add_option("--threads", request->render.launch.threads, "Threads per rank (default: 1)")
      ->group(group::kParallel)
      ->transform(count_between(1, 4096));
  add_timeout_option(*command, request->render.launch);
  command
      ->add_option("--codec", request->codecs,
                   "Pixel encodings to compare, separated by commas (default: active)")
      ->group(group::kSharing)
      ->delimiter(',')
      ->allow_extra_args(false);
  command
      ->add_flag("--interlace", request->interlace,
                 "Deal out pixels in turn, so that ranks get equal shares of uneven pictures")
      ->group(group::kSharing);
  command
      ->add_option(
          "--compose", request->schemes,
          "Compositing schemes to compare, separated by blanks (default: all; radix-k may be given "
          "its radices, such as radix-k:4,2)")
      ->group(group::kSharing);
  choose_scheme(*command);
  choose_from(*command, "--codec", names_in(composite::codecs()));
  add_comparison_options(*command, *request, "Measure less often",
                         "compositing schemes, pixel encodings and networks");
  add_common_options(*command, session,
                     "compare compose model.glb --ranks 2,4,8,1024 --codec active,dense\n"
                     "compare compose gen:terrain:1000000 --size 1920x1080 --stats compose.json");
  command->callback([&session, request, command] {
    session.run = [&session, request, command] { return run(session, *command, *request); };
  });
}

}  // namespace delray::apps
