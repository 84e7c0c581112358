// Which colour and mark a variant has, on all pages: by its place in its family's table.
#pragma once

#include <string_view>

#include "apps/report/look.h"

namespace delray::apps {

enum class Family { scheme, partition, schedule, strategy, method, distributed };

// The look of a variant by its name, which may go on with parameters behind a colon or a comma:
// "radix-k:4" looks like "radix-k" but for its dashes. A name that is not in the table has a look
// without a colour.
report::Look look_of(Family family, std::string_view name);

}  // namespace delray::apps
