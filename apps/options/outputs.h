// That nothing is overwritten which the same command reads or writes otherwise.
#pragma once

#include <string>
#include <vector>

namespace delray::apps {

struct OutputFile {
  std::string option;  // "-o"
  std::string path;    // empty: not asked for; "-": standard output
};

// Compares names and, for what exists, device and inode, so that links are seen through; standard
// input and output count as the files that they are connected to. Devices and pipes may be named
// twice, but standard output gets one output only. `inputs` may be empty or no files at all. Throws
// UsageError.
void refuse_overwriting(const std::vector<OutputFile>& outputs,
                        const std::vector<std::string>& inputs);

// Throws UsageError if "-" is a picture's path and standard output a terminal.
void refuse_terminal(const std::string& picture);

// As above, and throws the files::FileError of an output that cannot be written.
void check_outputs(const std::vector<OutputFile>& outputs, const std::vector<std::string>& inputs);

}  // namespace delray::apps
