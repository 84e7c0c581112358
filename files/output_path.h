// Where an output goes: to a file of its own, which is replaced whole, or through something that is
// there already and stays, such as a device or a pipe.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <optional>

namespace delray::files {

// Where an output goes once links are followed.
struct OutputPath {
  std::filesystem::path path;  // behind all links of its last name and its folders
  // A device, FIFO, socket or "-": there is nothing to replace, so its content is written into it.
  bool in_place = false;
  // The open file that "-", /dev/stdout or /dev/fd/N stand for.
  std::optional<int> descriptor;
  // Attributes of the existing file that will be replaced.
  std::optional<mode_t> mode;
  std::optional<uid_t> owner;
  std::optional<gid_t> group;
};

// Follows links, but none that somebody else may have planted: in a folder where everybody can
// write, a link, device or FIFO must belong to the user or to whom the folder belongs (the rule of
// fs.protected_symlinks and protected_fifos in Linux, for all folders that are open to everybody).
//
// Throws FileError (device) for such a link, for a folder, for a file that is write-protected, and
// where a folder on the way is missing. Nothing is opened: a FIFO without a reader does not block.
OutputPath output_path(const std::filesystem::path& path);

// As output_path() of a folder, which may be there already: its name behind all links, without a
// slash at the end. Throws FileError (device) for what is there and is no folder, too.
std::filesystem::path output_folder(const std::filesystem::path& path);

// Throws the FileError (device) that writing `path` would throw as far as that can be told before
// the work that makes the content; "-" and an empty path are fine.
void check_writable(const std::filesystem::path& path);

// Whether both names lead to one regular file, there or yet to be made; "-" is what `stream` (0 or
// 1) is connected to. False where a name leads nowhere.
struct NamedFile {
  std::filesystem::path path;
  int stream = 1;
};
bool is_same_file(const NamedFile& a, const NamedFile& b);

}  // namespace delray::files
