// Parses a page's options as the program parses its command line, and reads their descriptions back
// out of it.
#include "apps/view/look.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>

#include "apps/options/command_text.h"
#include "apps/options/usage.h"
#include "apps/render/run_command.h"

namespace delray::apps::view {
namespace {

using Scope = PanelOption::Scope;

constexpr PanelOption kPanel[] = {
    {"--engine"},
    {"--background"},
    {"--legend"},
    {"--ranks", Scope::ranks},
    {"--threads", Scope::ranks},
    {"--strategy"},
    {"--partition"},
    {"--schedule"},
    {"--compose"},
    {"--codec"},
    {"--costs"},
    {"--regions"},
    {"--shading"},
    {"--samples"},
    {"--error"},
    {"--integrator"},
    {"--spp"},
    {"--noise"},
    {"--depth"},
    {"--denoise"},
    {"--show"},
    {"--exposure"},
    {"--tone"},
    {"--aperture"},
    {"--focus"},
    {"--color-by", Scope::scene},
    {"--show-as", Scope::scene},
    {"--point-size", Scope::scene},
    {"--exaggeration", Scope::scene},
    {"--pose-time", Scope::scene},
    {"--animation", Scope::scene},
};

// A command with a request that it sets.
struct Parser {
  RenderRequest request;
  CLI::App command{"", "delray render"};
  Parser() { add_render_options(command, request); }
};

std::vector<std::string> words_of(const Input& input, const Options& options) {
  std::vector<std::string> words = input;
  for (const auto& [name, value] : options)
    words.push_back(value == "true" ? name : name + "=" + value);
  return words;
}

void parse(Parser& parser, const Input& input, const Options& options) {
  std::vector<std::string> words = words_of(input, options);
  words.insert(words.end(), {"-o", "picture.png"});
  try {
    std::vector<std::string> reversed(words.rbegin(), words.rend());  // as CLI11 takes them
    parser.command.parse(std::move(reversed));
  } catch (const CLI::ParseError& error) {
    throw UsageError(usage_message(parser.command, words, error));
  }
}

bool names_camera(const std::string& word) {
  constexpr const char* kOptions[] = {"--camera=", "--view=", "--clip="};
  return std::ranges::any_of(kOptions,
                             [&](const char* option) { return word.starts_with(option); });
}

const char* scope_text(Scope scope) {
  return scope == Scope::page ? "page" : scope == Scope::scene ? "scene" : "ranks";
}

Json json_of(const OptionText& text, const Options& options, const OptionState* state) {
  const std::string name = text.names.back();
  Json json = {{"name", name},
               {"help", full_description(text)},
               {"values", text.values},
               {"range", text.range},
               {"flag", !text.takes_value},
               {"value", option_of(options, name)},
               {"scope", scope_text(find_panel_option(name)->scope)}};
  if (state != nullptr) {
    json["default"] = state->value.is_string() ? state->value : Json(state->value.dump());
    json["idle"] = state->why_idle;
  }
  return json;
}

}  // namespace

void set_option(Options& options, const std::string& name, const std::string& value) {
  const auto found =
      std::ranges::find(options, name, [](const auto& option) { return option.first; });
  if (value.empty()) {
    if (found != options.end()) options.erase(found);
  } else if (found != options.end()) {
    found->second = value;
  } else {
    options.emplace_back(name, value);
  }
}

std::string option_of(const Options& options, const std::string& name) {
  const auto found =
      std::ranges::find(options, name, [](const auto& option) { return option.first; });
  return found == options.end() ? std::string() : found->second;
}

std::vector<PanelOption> panel_options() { return {std::begin(kPanel), std::end(kPanel)}; }

const PanelOption* find_panel_option(const std::string& name) {
  const auto* const found =
      std::ranges::find_if(kPanel, [&](const PanelOption& option) { return name == option.name; });
  return found == std::end(kPanel) ? nullptr : found;
}

RenderRequest make_request(const Input& input, Options& options) {
  // An option without effect may be the reason that another has none.
  constexpr int kRounds = 4;
  for (int round = 0;; ++round) {
    Parser parser;
    parse(parser, input, options);
    std::size_t before = options.size();
    const auto states = option_states(parser.command, parser.request);
    std::erase_if(options, [&](const auto& option) {
      const auto state = states.find(option.first);
      return state != states.end() && !state->second.why_idle.empty();
    });
    if (options.size() != before && round < kRounds) continue;
    check(parser.command, parser.request);
    return std::move(parser.request);
  }
}

Look make_look(const Input& input, const Options& options) {
  Look look;
  look.still_options = look.moving_options = options;
  look.still = make_request(input, look.still_options);
  set_option(look.moving_options, "--engine", "");
  set_option(look.moving_options, "--samples", "");
  look.moving = make_request(input, look.moving_options);
  return look;
}

void set_size(int width, int height, RenderRequest& request) {
  request.size = fmt::format("{}x{}", width, height);
  parse_size(request);
}

Json panel_of(const Input& input, const Options& options) {
  Options in_force = options;
  const RenderRequest ignored = make_request(input, in_force);
  Parser parser;
  parse(parser, input, in_force);
  const auto states = option_states(parser.command, parser.request);
  const CommandText command = command_text(parser.command);
  Json groups = Json::array();
  for (const PanelOption& shown : kPanel) {
    const auto text = std::ranges::find_if(command.options, [&](const OptionText& option) {
      return std::ranges::find(option.names, shown.name) != option.names.end();
    });
    OptionText own = *text;
    own.names = {shown.name};
    const auto state = states.find(shown.name);
    const Json option = json_of(own, options, state == states.end() ? nullptr : &state->second);
    auto group = std::ranges::find_if(
        groups, [&](const Json& known) { return known["name"] == own.heading; });
    if (group == groups.end()) {
      groups.push_back({{"name", own.heading}, {"options", Json::array()}});
      group = groups.end() - 1;
    }
    (*group)["options"].push_back(option);
  }
  return groups;
}

std::string command_for(const Input& input, const Look& look, const CameraWords& camera) {
  std::vector<std::string> words = {"delray", "render"};
  for (const std::string& word : words_of(input, look.still_options))
    if (camera.camera.empty() || !names_camera(word)) words.push_back(word);
  words.insert(words.end(), {"--size", look.still.size});
  if (!camera.camera.empty()) words.push_back("--camera=" + camera.camera);
  if (camera.clip > 0) words.push_back(fmt::format("--clip={}", camera.clip));
  words.insert(words.end(), {"-o", "picture.png"});
  return quoted_command(words);
}

}  // namespace delray::apps::view
