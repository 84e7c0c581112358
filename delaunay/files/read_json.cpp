// JSON: an array of arrays of two or three numbers.
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "delaunay/files/point_readers.h"
#include "delaunay/files/text_rows.h"

namespace delray::delaunay {
namespace {

// Receives what the parser finds, so that no tree of the file is built.
class Handler : public nlohmann::json_sax<nlohmann::json> {
 public:
  explicit Handler(const Input& input) : input_(&input) {}

  bool number_integer(number_integer_t value) override { return add(static_cast<double>(value)); }
  bool number_unsigned(number_unsigned_t value) override { return add(static_cast<double>(value)); }
  bool number_float(number_float_t, const string_t& text) override {
    // Not the parser's own value: that depends on the locale.
    double value = 0;
    if (parse_number(text, value) != NumberError::none) complain("not a finite number");
    return add(value);
  }
  bool start_array(std::size_t) override {
    if (++depth_ > 2) complain("arrays within a point");
    coordinates_ = 0;
    return true;
  }
  bool end_array() override {
    if (depth_-- == 2) {
      if (coordinates_ < 2) complain("a point needs two or three numbers");
      if (cloud.positions.empty()) cloud.has_z = coordinates_ == 3;
      if ((coordinates_ == 3) != cloud.has_z) {
        complain("points of two and of three numbers are mixed");
      }
      cloud.positions.push_back(point_);
    }
    return true;
  }
  bool null() override { complain("null instead of a number"); }
  bool boolean(bool) override { complain("a truth value instead of a number"); }
  bool string(string_t&) override { complain("a string instead of a number"); }
  bool binary(binary_t&) override { complain("binary data instead of a number"); }
  bool start_object(std::size_t) override { complain("an object instead of an array"); }
  bool key(string_t&) override { complain("an object instead of an array"); }
  bool end_object() override { complain("an object instead of an array"); }
  bool parse_error(std::size_t byte, const std::string&,
                   const nlohmann::json::exception& error) override {
    const bool range = error.id == 406;
    fail(*input_, at_byte(byte), range ? "not a finite number" : "not JSON");
  }

  PointCloud cloud;

 private:
  [[noreturn]] void complain(const char* what) const {
    fail(*input_, "point " + std::to_string(cloud.size()), what);
  }
  bool add(double value) {
    if (depth_ != 2) complain("a number outside of a point");
    if (coordinates_ == 3) complain("a point has more than three numbers");
    if (coordinates_ == 0) point_ = glm::dvec3(0);
    point_[coordinates_++] = value;
    return true;
  }

  const Input* input_;
  glm::dvec3 point_{0};
  int depth_ = 0, coordinates_ = 0;
};

}  // namespace

PointCloud read_json_points(const Input& input) {
  // Nobody knows their number before the end: the list may be twice as long as it need be, beside
  // half of it from where it was before.
  const auto ends = std::count(input.content.begin(), input.content.end(), ']');
  input.require_memory(3 * sizeof(glm::dvec3) * static_cast<std::uint64_t>(ends));
  Handler handler(input);
  nlohmann::json::sax_parse(input.content.begin(), input.content.end(), &handler);
  return std::move(handler.cloud);
}

}  // namespace delray::delaunay
