// Enumerates the legal options from the table of methods in nested loops; an empty choice becomes
// "none".
#include "delaunay/combinations.h"

#include <algorithm>
#include <string_view>

#include "delaunay/methods.h"

namespace delray::delaunay {

std::vector<Options> combinations(int dim) {
  using Names = std::vector<std::string_view>;
  const auto or_none = [](const Names& names) { return names.empty() ? Names{"none"} : names; };
  std::vector<Options> result;
  for (const Method& method : methods()) {
    if (std::ranges::find(method.dims, dim) == method.dims.end()) continue;
    Options options;
    options.dim = dim;
    options.method = method.name;
    for (const auto location : or_none(locations_for(method, dim))) {
      options.location = location;
      for (const auto split : or_none(method.splits)) {
        options.split = split;
        for (const auto order : or_none(orders_for(method, location))) {
          options.order = order;
          for (const auto strategy : or_none(method.deadlocks)) {
            options.deadlocks = strategy;
            result.push_back(options);
          }
        }
      }
    }
  }
  return result;
}

std::vector<Options> locations_and_orders(int dim) {
  std::vector<Options> result = combinations(dim);
  std::erase_if(result, [](const Options& options) {
    Options plain = options;
    plain.split = "auto";
    plain.deadlocks = "auto";
    plain = resolve(plain);
    return plain.split != options.split || plain.deadlocks != options.deadlocks;
  });
  return result;
}

std::string name_of(const Options& options) {
  return options.method + "/" + options.location + "/" + options.split + "/" + options.order + "/" +
         options.deadlocks;
}

}  // namespace delray::delaunay
