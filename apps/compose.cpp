// delray compose: merges images that other programs have rendered.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <limits>
#include <memory>

#include "apps/commands.h"
#include "apps/families.h"
#include "apps/launch.h"
#include "apps/options/help.h"
#include "apps/options/input_limits.h"
#include "apps/options/list.h"
#include "apps/options/outputs.h"
#include "apps/options/scheme_option.h"
#include "apps/render/write_picture.h"
#include "apps/statistics.h"
#include "comm/agree_on_failure.h"
#include "comm/collectives.h"
#include "comm/ledger.h"
#include "comm/recording.h"
#include "composite/codec.h"
#include "composite/dense.h"
#include "composite/scheme.h"
#include "composite/write_parts.h"
#include "files/error.h"
#include "files/output_path.h"
#include "image/io.h"

namespace delray::apps {
namespace {

struct ComposeRequest {
  std::vector<std::string> parts;
  std::string output, scheme = "radix-k", codec = "active", statistics;
  bool ordered = false, interlace = false, in_pieces = false, list = false;
  Launch launch;
  InputLimits limits;
};

[[noreturn]] void bad(const std::string& file, const std::string& what) {
  throw files::FileError(files::Cause::input, file, "", what);
}

// As layers want it: what nothing covers is empty in colour and depth.
image::ImageF read_part(const ComposeRequest& request, const std::string& file) {
  const files::MemoryBudget memory = request.limits.budget();
  if (!request.ordered) {
    const std::vector<std::string> channels = image::read_info(file, memory).channels;
    if (std::find(channels.begin(), channels.end(), "Z") == channels.end()) {
      bad(file,
          "has no depth (a channel Z); --ordered puts pictures over each other in the order "
          "given");
    }
  }
  image::ImageF image = image::read_image_float(file, memory);
  for (std::size_t i = 0; i < image.pixels(); ++i) {
    image::RgbaF& colour = image.colour[i];
    float& depth = image.depth[i];
    if (depth != depth) bad(file, fmt::format("the depth of pixel {} is not a number", i));
    if (colour == image::RgbaF{}) {
      colour = {};  // no negative zeros
      depth = image::kEmptyDepth;
    } else if (depth == image::kEmptyDepth) {
      depth = std::numeric_limits<float>::max();  // a background: behind everything else
    }
  }
  return image;
}

// The parts of a rank, an equal share of the list, merged; no pixels where there are none.
image::ImageF read_parts(const ComposeRequest& request, composite::Operator how, std::size_t begin,
                         std::size_t end) {
  std::unique_ptr<composite::Layer> merged;
  int width = 0, height = 0;
  for (std::size_t i = begin; i < end; ++i) {
    image::ImageF image = read_part(request, request.parts[i]);
    if (merged != nullptr && (image.width != width || image.height != height)) {
      bad(request.parts[i], fmt::format("is {} x {}, {} is {} x {}", image.width, image.height,
                                        request.parts[begin], width, height));
    }
    width = image.width;
    height = image.height;
    auto layer = composite::make_dense(std::move(image), how);
    if (merged == nullptr) {
      merged = std::move(layer);
    } else {
      const composite::PixelRange all{0, layer->pixels()};
      merged->merge(all, layer->encode(all), composite::Side::higher);
    }
  }
  if (merged == nullptr) return {};
  return composite::take_image<image::RgbaF>({{}, std::move(merged)});
}

// Ranks without a part get an empty image of everybody's size.
void agree_on_size(comm::Communicator& communicator, const std::string& file,
                   image::ImageF& image) {
  const auto largest = [&](int value) {
    return comm::all_reduce_value(communicator, value, [](int a, int b) { return std::max(a, b); });
  };
  const int width = largest(image.width), height = largest(image.height);
  comm::all_or_none(communicator, comm::Phase::load, [&] {
    if (image.pixels() == 0) {
      image = image::ImageF(width, height);
      clear(image);
    } else if (image.width != width || image.height != height) {
      bad(file, fmt::format("is {} x {}, others are up to {} x {}", image.width, image.height,
                            width, height));
    }
  });
}

// Layers over each other have no depth: 0 where something is.
void set_depths(composite::OwnedPixels& part) {
  image::ImageF& image = dynamic_cast<composite::ImageLayer<image::RgbaF>&>(*part.layer).image();
  for (const composite::PixelRange& range : part.ranges) {
    for (std::size_t i = range.begin; i < range.end; ++i) {
      image.depth[i] = image.colour[i].a > 0 ? 0 : image::kEmptyDepth;
    }
  }
}

struct Outcome {
  image::ImageF image;  // on rank 0, of no use where pieces were written
  double read = 0, compose = 0, gather = 0, write = 0;
  comm::Totals composed, gathered;
};

Outcome compose_parts(comm::Communicator& communicator, const ComposeRequest& request) {
  const auto how = request.ordered ? composite::Operator::over : composite::Operator::nearest;
  const auto share = [&](int rank) {
    return request.parts.size() * static_cast<std::size_t>(rank) /
           static_cast<std::size_t>(communicator.size());
  };
  const std::size_t begin = share(communicator.rank()), end = share(communicator.rank() + 1);
  Outcome outcome;
  Stopwatch stopwatch;
  image::ImageF image = comm::all_or_none(communicator, comm::Phase::load, [&] {
    if (communicator.rank() == 0) {
      files::check_writable(request.output);
      files::check_writable(request.statistics);
    }
    return read_parts(request, how, begin, end);
  });
  agree_on_size(communicator, begin < end ? request.parts[begin] : "", image);
  outcome.read = stopwatch.lap();

  std::vector<comm::Event> events;
  comm::Recording recording(communicator, events);
  auto layer = composite::find_codec(request.codec)->make(std::move(image), how);
  composite::OwnedPixels part = composite::compose(recording, std::move(layer), request.scheme,
                                                   {.interlace = request.interlace});
  outcome.compose = stopwatch.lap();
  if (request.ordered) set_depths(part);
  if (request.in_pieces) {
    composite::write_parts(communicator, part, request.output);
    outcome.write = stopwatch.lap();
  } else {
    part = composite::gather(recording, std::move(part), 0);
    outcome.gather = stopwatch.lap();
  }
  const comm::Ledger ledger = comm::gather_ledger(communicator, events);
  if (communicator.rank() != 0) return outcome;
  outcome.composed = comm::totals(ledger, comm::Phase::compose);
  outcome.gathered = comm::totals(ledger, comm::Phase::gather);
  if (request.ordered) set_depths(part);  // those of other ranks have not come along
  outcome.image = composite::take_image<image::RgbaF>(std::move(part));
  return outcome;
}

void check(const Session& session, const ComposeRequest& request) {
  if (request.parts.empty()) throw UsageError("compose: PART is missing");
  if (request.output.empty()) throw UsageError("compose: -o IMAGE is missing");
  if (!image::is_picture_suffix(request.output)) {
    throw UsageError(fmt::format("-o: '{}' is not a picture", request.output));
  }
  if (!session.under_mpi) refuse_terminal(request.output);
  if (request.in_pieces && !request.output.ends_with(".exr")) {
    throw UsageError("--in-pieces: only .exr files have a place for every pixel beforehand");
  }
  if (request.in_pieces && session.metadata) {
    throw UsageError("--metadata has no effect with --in-pieces");
  }
  refuse_overwriting({{"-o", request.output}, {"--stats", request.statistics}}, request.parts);
}

int run(const Session& session, const ComposeRequest& request) {
  if (request.list) {
    if (session.first_process) {
      list_schemes();
      list_codecs();
    }
    return kDone;
  }
  check(session, request);
  check(session, request.launch);
  // A rank reads its own parts only, which may lie on its machine alone.
  run_ranks(session, request.launch, {}, [&](comm::Communicator& communicator) {
    Outcome outcome = compose_parts(communicator, request);
    comm::all_or_none(communicator, comm::Phase::other, [&] {
      if (communicator.rank() != 0) return;
      const int width = outcome.image.width, height = outcome.image.height;
      std::string hash;
      if (!request.in_pieces) {
        Stopwatch stopwatch;
        const Picture picture = std::move(outcome.image);
        hash = write_picture(session, request.output, picture);
        outcome.write = stopwatch.lap();
      }
      constexpr auto kPixels = static_cast<std::size_t>(comm::Work::pixels_composited);
      write_statistics(request.statistics,
                       {{"schema", "delray.compose/1"},
                        {"parts", request.parts},
                        {"options",
                         {{"ranks", communicator.size()},
                          {"compose", request.scheme},
                          {"codec", request.codec},
                          {"ordered", request.ordered},
                          {"interlace", request.interlace},
                          {"in_pieces", request.in_pieces}}},
                        {"image", {{"width", width}, {"height", height}, {"hash", hash}}},
                        {"seconds",
                         {{"read", outcome.read},
                          {"compose", outcome.compose},
                          {"gather", outcome.gather},
                          {"write", outcome.write}}},
                        {"rounds", outcome.composed.rounds},
                        {"messages", outcome.composed.messages_sent},
                        {"bytes", outcome.composed.bytes_sent},
                        {"bytes_gathered", outcome.gathered.bytes_sent},
                        {"pixels_composited", outcome.composed.work[kPixels]}});
    });
  });
  return kDone;
}

}  // namespace

void add_compose(CLI::App& program, Session& session) {
  CLI::App* command =
      program.add_subcommand("compose", "Merge pictures that were rendered elsewhere");
  const auto request = std::make_shared<ComposeRequest>();
  command
      ->add_option("PART", request->parts,
                   "EXR pictures with depth (a channel Z): at every pixel the nearest is seen, the "
                   "first of those at equal depth")
      ->group(group::kInput);
  command
      ->add_option("-o,--output", request->output,
                   "Picture to write: .png, .exr, .tif or .jpg; - for PNG on standard output")
      ->type_name("FILE")
      ->group(group::kOutput);
  command->add_flag("--ordered", request->ordered,
                    "Lay the parts over each other, the first in front; no depth is needed");
  command
      ->add_option("--compose", request->scheme,
                   "Compositing scheme: which rank sends which pixels to which (default: radix-k, "
                   "which may be given its radices, such as radix-k:4,2; --list describes them)")
      ->group(group::kSharing);
  command->add_option("--codec", request->codec, "Pixel encoding between ranks (default: active)")
      ->group(group::kSharing);
  command
      ->add_flag("--interlace", request->interlace,
                 "Deal out pixels in turn, so that ranks get equal shares of uneven pictures")
      ->group(group::kSharing);
  command
      ->add_flag("--in-pieces", request->in_pieces,
                 "Let every rank write its own pixels into the EXR, instead of sending them to "
                 "one; no hash is told")
      ->group(group::kSharing);
  add_memory_option(*command, request->limits);
  add_launch_options(*command, request->launch);
  add_metadata_option(*command, session);
  command
      ->add_option("--stats", request->statistics,
                   "Statistics as JSON to this file; - for standard output")
      ->type_name("FILE")
      ->group(group::kOutput);
  command->add_flag("--list", request->list, "List the compositing schemes and pixel encodings")
      ->group(group::kOutput);
  choose_scheme(*command);
  choose_from(*command, "--codec", names_in(composite::codecs()));
  add_common_options(*command, session,
                     "compose part-0.exr part-1.exr -o picture.exr\n"
                     "compose front.exr back.exr --ordered -o picture.png --stats -");
  command->callback([&session, request] {
    session.run = [&session, request] { return run(session, *request); };
  });
}

}  // namespace delray::apps
