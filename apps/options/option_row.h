// Options of a command as rows of a table: a row is the one description of an option, which the
// parser, the statistics, the manual and the check of what goes with what all come from.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "apps/options/list.h"
#include "apps/statistics.h"

namespace delray::apps {

// The description of one option. A field is a function from a request, constant or not, to a
// reference to what the option sets.
template <class Request>
class OptionRow {
 public:
  // The long name.
  std::string flag() const { return names_.substr(names_.rfind(',') + 1); }
  CLI::Option* add(CLI::App& command, Request& request) const {
    CLI::Option* option = add_(command, request);
    option->description(help_)->group(group_);
    for (const auto& step : steps_) step(command, *option);
    return option;
  }
  // The value that it is set to, for statistics; see reported.
  Json value(const Request& request) const { return value_(request); }
  const std::string& key() const { return key_; }
  // Why the option changes nothing beside the others of a request; empty where it does: see
  // unless().
  std::string why_idle(const Request& request) const {
    return why_idle_ ? why_idle_(request) : std::string();
  }
  bool is_reported(const Request& request) const {
    return !key_.empty() && (!reported_ || reported_(request));
  }
  // Whether samples depend on it; see in_checkpoint.
  bool is_in_checkpoint() const { return in_checkpoint_; }
  std::string checkpoint_text(const Request& request) const {
    if (text_) return text_(request);
    const Json set = value(request);
    return set.is_string() ? set.template get<std::string>() : set.dump();
  }

  OptionRow check(CLI::Validator validator) && {
    return step([v = std::move(validator)](CLI::App&, CLI::Option& option) { option.check(v); });
  }
  OptionRow transform(CLI::Validator validator) && {
    return step(
        [v = std::move(validator)](CLI::App&, CLI::Option& option) { option.transform(v); });
  }
  OptionRow type_name(std::string name) && {
    return step([n = std::move(name)](CLI::App&, CLI::Option& option) { option.type_name(n); });
  }
  // The other option is in a row above, or the command does not have it.
  OptionRow excludes(std::string other) && {
    return step([o = std::move(other)](CLI::App& command, CLI::Option& option) {
      if (CLI::Option* const there = command.get_option_no_throw(o)) option.excludes(there);
    });
  }
  OptionRow one_of(std::vector<std::string> legal, OtherValues others = {}) && {
    return step([l = std::move(legal), others](CLI::App& command, CLI::Option& option) {
      choose_from(command, option.get_name(), l, others);
    });
  }
  // The key in statistics, and where they have it.
  OptionRow reported(std::string key, std::function<bool(const Request&)> where = {}) && {
    key_ = std::move(key);
    reported_ = std::move(where);
    return std::move(*this);
  }
  // Samples depend on it: a checkpoint keeps it as this text, by default that of its value, and is
  // refused where the text is another.
  OptionRow in_checkpoint(std::function<std::string(const Request&)> text = {}) && {
    in_checkpoint_ = true;
    text_ = std::move(text);
    return std::move(*this);
  }
  // The option changes nothing where `why_idle` returns a text, which says why.
  OptionRow unless(std::function<std::string(const Request&)> why_idle) && {
    why_idle_ = std::move(why_idle);
    return std::move(*this);
  }

  // A text or a number; a flag where the field is a bool.
  template <class Field>
  static OptionRow of(std::string names, Field field, const char* group, std::string help) {
    OptionRow row(std::move(names), group, std::move(help));
    using Value = std::remove_cvref_t<decltype(field(std::declval<Request&>()))>;
    row.add_ = [all = row.names_, field](CLI::App& command, Request& request) {
      if constexpr (std::is_same_v<Value, bool>) {
        return command.add_flag(all, field(request));
      } else {
        return command.add_option(all, field(request));
      }
    };
    row.value_ = [field](const Request& request) { return Json(field(request)); };
    return row;
  }
  // A flag that sets a bool to false.
  template <class Field>
  static OptionRow off(std::string names, Field field, const char* group, std::string help) {
    OptionRow row(std::move(names), group, std::move(help));
    row.add_ = [all = row.names_, field](CLI::App& command, Request& request) {
      return command.add_flag_callback(all, [field, &request] { field(request) = false; });
    };
    row.value_ = [field](const Request& request) { return Json(field(request)); };
    return row;
  }
  // One of some names, each for a value.
  template <class Value, class Field>
  static OptionRow choice(std::string names, Field field,
                          std::vector<std::pair<std::string, Value>> values, const char* group,
                          std::string help) {
    OptionRow row(std::move(names), group, std::move(help));
    std::vector<std::string> legal;
    for (const auto& [name, value] : values) legal.push_back(name);
    row.add_ = [all = row.names_, field, values](CLI::App& command, Request& request) {
      return command.add_option_function<std::string>(
          all, [field, values, &request](const std::string& chosen) {
            for (const auto& [name, value] : values) {
              if (name == chosen) field(request) = value;
            }
          });
    };
    row.value_ = [field, values](const Request& request) {
      for (const auto& [name, value] : values) {
        if (value == field(request)) return Json(name);
      }
      return Json();
    };
    return std::move(row).check(apps::one_of(legal));
  }

 private:
  OptionRow(std::string names, const char* group, std::string help)
      : names_(std::move(names)), group_(group), help_(std::move(help)) {}
  template <class Step>
  OptionRow step(Step&& step) {
    steps_.emplace_back(std::forward<Step>(step));
    return std::move(*this);
  }

  std::string names_;  // as CLI11 has them: "-o,--output"
  const char* group_;
  std::string help_, key_;
  std::function<CLI::Option*(CLI::App&, Request&)> add_;
  std::function<Json(const Request&)> value_;
  std::vector<std::function<void(CLI::App&, CLI::Option&)>> steps_;
  std::function<std::string(const Request&)> why_idle_;
  std::function<bool(const Request&)> reported_;
  bool in_checkpoint_ = false;
  std::function<std::string(const Request&)> text_;
};

}  // namespace delray::apps
