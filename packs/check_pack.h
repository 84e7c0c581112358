// Packs read whole, for who wants to know that nothing of them is damaged.
#pragma once

#include "packs/pack_reader.h"
#include "parallel/progress.h"

namespace delray::packs {

// Reads every page, as PackReader::read does, and looks whether pages follow each other without
// gaps. Parallel, in the memory of some pages. Throws FileError for the first page, in the order of
// the file, that is not as it was written: (input), or (device) where the disk cannot be read.
void check_pack(const PackReader& pack, parallel::Progress* progress = nullptr);

}  // namespace delray::packs
