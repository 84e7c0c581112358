// A pipeline over several ranks, of which all end alike.
#pragma once

#include "comm/communicator.h"
#include "parallel/pipeline.h"

namespace delray::comm {

// Collective: parallel::run_pipeline of the same number of items on every rank, where stage
// `collective` is the only one that communicates. Whichever thread runs it uses the communicator,
// one at a time, for the items in ascending order.
//
// What any stage but this throws on any rank keeps the item, and those after it, from further
// stages there; before stage `collective` of an item ranks agree whether there was anything of the
// kind, and once more at the end, and then all throw it as agree_on_failure does; a single rank
// throws it as it is. An all_reduce of a number for each item.
//
// REQUIRES: stage `collective` is in order.
parallel::PipelineTimes run_agreed_pipeline(Communicator& communicator, std::size_t items,
                                            std::size_t slots,
                                            std::span<const parallel::PipelineStage> stages,
                                            std::size_t collective, Phase phase = Phase::other);

}  // namespace delray::comm
