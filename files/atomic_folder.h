// Folders that appear whole or not at all.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace delray::files {

// What is to become of a folder that a run before this one left unfinished.
// Processes that fill one folder together: the first one makes it, and the others join it.
enum class Unfinished : std::uint8_t { removed, resumed, joined };

// A folder beside `path`, named .NAME.delray-part, that is filled and then takes the name. Not
// committed, it is removed with all that is in it, and `path` stays as it was; after keep(), or
// where the process is killed, it stays for a later run that resumes it. Two runs cannot fill it at
// a time. Files in it are made and opened below its descriptor, never through links.
//
// Who joined a folder neither removes anything but what it names nor commits.
//
// A folder that is there already is replaced, but only if it is empty or each of its entries is a
// file whose name `is_own` knows, and one is `index`. An unfinished one that has files of other
// names is refused: nothing else is ever removed.
//
// Everything throws FileError (device), naming `path`. Any thread may make files.
class AtomicFolder {
 public:
  using NameTest = std::function<bool(std::string_view name)>;

  struct Options {
    std::string index;  // the name of a file that every folder of this kind has
    NameTest is_own;    // other names that such folders have
    Unfinished unfinished = Unfinished::removed;
    NameTest is_temporary = nullptr;  // names that only unfinished folders have
  };

  AtomicFolder(std::filesystem::path path, Options options);
  ~AtomicFolder();
  AtomicFolder(const AtomicFolder&) = delete;
  AtomicFolder& operator=(const AtomicFolder&) = delete;

  // The folder as the user named it, for messages.
  const std::filesystem::path& path() const { return path_; }
  // Where the files lie until commit().
  const std::filesystem::path& temporary() const { return temporary_; }
  // The names of the files that are in it.
  std::vector<std::string> names() const;
  // A descriptor of a new file, to write to. Nothing of that name may be there. The caller closes
  // it.
  int create(const std::string& name) const;
  // A descriptor of a file to append to, and to read, made where it is missing.
  int append(const std::string& name) const;
  void rename(const std::string& from, const std::string& to) const;
  void remove(const std::string& name) const;
  // What has been written is not removed without commit().
  void keep() { keep_ = true; }
  // Gives the folder its name. Everything has reached the disk then.
  void commit();

 private:
  [[noreturn]] void fail(int error) const;
  [[noreturn]] void fail(const std::string& why) const;
  void check_replaceable() const;
  std::string foreign_to_unfinished() const;
  bool open_partial();
  void remove_all(int folder) const;
  std::vector<std::string> names_in(int folder) const;

  std::filesystem::path path_, target_, temporary_;
  Options options_;
  int descriptor_ = -1;  // of the folder; locked
  bool keep_ = false, committed_ = false;
};

}  // namespace delray::files
