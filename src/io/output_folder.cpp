#include "bough/io/output_folder.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <thread>

#include "bough/io/atomic_file.hpp"
#include "bough/io/digest.hpp"
#include "bough/io/input_file.hpp"
#include "error_text.hpp"

namespace bough::io {
namespace {

namespace fs = std::filesystem;

constexpr const char* inner_name = ".bough-new";  // of a staging folder within the final one
constexpr const char* former_name = ".former";  // within a staging folder: entries that were moved out of the final one

[[noreturn]] void fail(const fs::path& folder, int error) {
  throw std::runtime_error("cannot write into " + folder.string() + ": " + error_text(error));
}

/// The folder to which the user's name leads. If it does not exist, the name within its existing parent.
fs::path resolved(const fs::path& folder) {
  const fs::file_status there = fs::symlink_status(folder);
  if (fs::is_symlink(there) && !fs::exists(fs::status(folder)))
    throw std::runtime_error("cannot write into " + folder.string() + ": it is a link that leads nowhere");
  fs::path absolute = fs::absolute(folder).lexically_normal();
  if (!absolute.has_filename()) absolute = absolute.parent_path();  // "out/"
  return fs::weakly_canonical(absolute);
}

/// Whether the folder cannot be renamed: it is the working directory of this process or the root of a file system, or
/// its parent cannot be written.
bool has_to_stay(const fs::path& folder) {
  struct stat own = {}, above = {};
  if (::stat(folder.c_str(), &own) != 0 || ::stat(folder.parent_path().c_str(), &above) != 0) return false;
  if (own.st_dev != above.st_dev || own.st_ino == above.st_ino) return true;
  if (::access(folder.parent_path().c_str(), W_OK | X_OK) != 0) return true;
  std::error_code error;
  const fs::path inside = fs::current_path(error).lexically_relative(folder);
  return !error && !inside.empty() && *inside.begin() != "..";
}

/// Whether a folder can be moved into another one.
bool can_move_to(const fs::path& folder, const fs::path& parent) {
  struct stat own = {}, above = {};
  return ::stat(folder.c_str(), &own) == 0 && ::stat(parent.c_str(), &above) == 0 && own.st_dev == above.st_dev &&
         ::access(parent.c_str(), W_OK | X_OK) == 0;
}

/// Renames; returns 0 or the error.
int rename_to(const fs::path& from, const fs::path& to) { return ::rename(from.c_str(), to.c_str()) == 0 ? 0 : errno; }

/// Exchanges two names at once; returns 0 or the error.
int exchange(const fs::path& a, const fs::path& b) {
  return ::renameat2(AT_FDCWD, a.c_str(), AT_FDCWD, b.c_str(), RENAME_EXCHANGE) == 0 ? 0 : errno;
}

bool is_folder(const fs::path& path) {
  std::error_code ignored;
  return fs::is_directory(fs::symlink_status(path, ignored));
}

/// Folders within that are not part of the results themselves. Most results contain no folder; then no manifest is
/// read.
std::vector<std::string> guests_of(const fs::path& folder) {
  std::vector<std::string> guests;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder))
    if (!entry.is_symlink() && entry.is_directory() && entry.path().filename() != former_name)
      guests.push_back(entry.path().filename().string());
  if (guests.empty()) return guests;
  const Manifest manifest = read_manifest(folder).value_or(Manifest{});
  std::erase_if(guests, [&](const std::string& name) {
    return std::any_of(manifest.files.begin(), manifest.files.end(),
                       [&](const FileRecord& r) { return r.name.starts_with(name + "/"); });
  });
  return guests;
}

/// Moves entries by name; entries that already exist stay. Returns 0 or the first error.
int move_names(const std::vector<std::string>& names, const fs::path& from, const fs::path& to) {
  int error = 0;
  for (const std::string& name : names)
    if (!fs::exists(fs::symlink_status(to / name)))
      if (const int e = rename_to(from / name, to / name); e != 0 && error == 0) error = e;
  return error;
}

/// Existing top-level names listed in a manifest, the manifest itself first.
std::vector<std::string> top_names(const fs::path& folder) {
  std::vector<std::string> names;
  if (!read_manifest(folder)) return names;
  names.emplace_back(manifest_name);
  const std::vector<std::string> guests = guests_of(folder);
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    const bool is_guest = std::find(guests.begin(), guests.end(), name) != guests.end();
    if (!is_guest && name != manifest_name && name != former_name) names.push_back(name);
  }
  return names;
}

/// Moves back the entries that were moved out of the final folder and not yet replaced. The manifest of the new entries
/// is moved last.
void put_back(const fs::path& former, const fs::path& staging, const fs::path& final) {
  std::vector<std::string> added, back;
  for (const FileRecord& file : read_manifest(staging).value_or(Manifest{}).files) {
    const std::string top = fs::path(file.name).begin()->string();
    const bool is_known = std::find(added.begin(), added.end(), top) != added.end();
    if (!is_known && fs::exists(fs::symlink_status(final / top))) added.push_back(top);
  }
  for (const fs::directory_entry& entry : fs::directory_iterator(former))
    back.push_back(entry.path().filename().string());
  if (move_names(added, final, staging) != 0 || move_names(back, former, final) != 0)
    throw std::runtime_error("cannot put back the results of " + final.string() + " from " + former.string());
}

/// Cleans up after a writer that was killed: removes its files, and moves back the entries that it had moved out of the
/// final folder.
void settle(const fs::path& staging, const fs::path& final) {
  const fs::path former = staging / former_name;
  if (!read_manifest(staging) && !is_folder(former) && !foreign_entries(staging, 1).empty())
    throw OutputRefused("cannot write into " + final.string() + ": " + staging.string() +
                        " is in the way, and bough did not write it");
  if (is_folder(former)) {
    if (!read_manifest(final)) put_back(former, staging, final);
    remove_listed(former);
  }
  if (is_folder(final)) (void)move_names(guests_of(staging), staging, final);
  fs::remove(staging / (std::string(manifest_name) + ".partial"));
  remove_listed(staging);
}

/// Whether a staging folder holds the history of a run that was killed while it wrote it, with so many whole lines.
bool has_lines_of_killed(const fs::path& staging, std::ptrdiff_t least_lines) {
  const std::optional<Manifest> there = read_manifest(staging);
  const fs::path rows = staging / "history.csv.partial";
  if (!there || there->state != FolderState::unfinished || there->made_by != "run" ||
      is_folder(staging / former_name) || !fs::is_regular_file(fs::symlink_status(rows)))
    return false;
  const std::string text = read_text(rows);
  return std::count(text.begin(), text.end(), '\n') >= least_lines;
}

/// Makes failed results of them: files get their names, the history ends with its last whole row.
void publish_rows_of_killed(const fs::path& staging, const fs::path& place, const std::string& instead_of) {
  const fs::path rows = staging / "history.csv.partial";
  fs::resize_file(rows, read_text(rows).rfind('\n') + 1);
  for (const char* name : {"history.csv", "history.npy", "motion.bin"})
    if (const fs::path partial = staging / (std::string(name) + ".partial"); fs::exists(fs::symlink_status(partial)))
      fs::rename(partial, staging / name);
  Manifest manifest = read_manifest(staging).value();
  manifest.state = FolderState::failed;
  manifest.instead_of = instead_of;
  write_file(staging / manifest_name, manifest_text(manifest));
  if (const int error = rename_to(staging, place); error != 0) fail(place, error);
}

/// Staging folder for results whose place is known.
fs::path staging_at(const fs::path& place, bool stays) {
  return stays ? place / inner_name : place.parent_path() / ("." + place.filename().string() + ".bough-new");
}

}  // namespace

fs::path OutputFolder::staging_of(const fs::path& folder) {
  const fs::path place = resolved(folder);
  return staging_at(place, has_to_stay(place));
}

std::vector<fs::path> OutputFolder::unfinished_in(const fs::path& folder, const Owner& owner) {
  const fs::path final = resolved(folder);
  std::vector<fs::path> places;
  const auto look_at = [&](const fs::path& place, FolderState state, const std::string& instead_of) {
    const std::optional<Manifest> there = is_folder(place) ? read_manifest(place) : std::nullopt;
    if (there && there->state == state && (instead_of.empty() || there->instead_of == instead_of) &&
        there->key == owner.key && !is_of_another(place, owner))
      places.push_back(place);
  };
  look_at(staging_of(folder), FolderState::unfinished, "");
  look_at(final, FolderState::failed, "");
  std::error_code none;  // of a folder whose parent does not exist yet
  for (const fs::directory_entry& entry : fs::directory_iterator(final.parent_path(), none))
    if (entry.path().filename().string().starts_with(final.filename().string() + ".failed"))
      look_at(entry.path(), FolderState::failed, final.filename().string());
  return places;
}

OutputFolder::OutputFolder(fs::path folder, Owner owner, std::vector<std::string> names,
                           const std::vector<fs::path>& inputs, const fs::path& resumed)
    : shown_(std::move(folder)), final_(resolved(shown_)), owner_(std::move(owner)), names_(std::move(names)) {
  refuse_inputs_within(inputs, final_);
  std::error_code error;
  fs::create_directories(final_.parent_path(), error);
  if (error)
    throw std::runtime_error("cannot make the directory " + final_.parent_path().string() + ": " + error.message());
  if (fs::exists(fs::symlink_status(final_)) && !is_folder(final_))
    throw std::runtime_error("cannot write into " + shown_.string() + ": not a directory");
  is_in_place_ = has_to_stay(final_);
  staging_ = staging_at(final_, is_in_place_);
  if (!resumed.empty()) take_over(resumed);
  claim_staging();
  try {
    if (resumed.empty())
      settle_former_staging();
    else
      remove_added();
    require_ours(final_, owner_);  // a batch that runs there is told at once, not waited for
    lock_final();
    require_ours(final_, owner_);
    prepare_staging();
  } catch (...) {
    fs::remove(staging_, error);  // removes it only if it is empty
    throw;
  }
}

/// Makes a place of unfinished results the staging folder; where the final folder stays, its entries go there.
void OutputFolder::take_over(const fs::path& resumed) {
  if (resumed == staging_) return;
  if (FolderLock lock; !lock.take(resumed)) throw std::runtime_error(taken_by_another());
  if (is_folder(staging_)) settle_former_staging();
  fs::remove(staging_);
  if (is_in_place_ && resumed == final_) {
    const std::vector<std::string> names = top_names(final_);
    if (::mkdir(staging_.c_str(), 0777) != 0) fail(shown_, errno);
    if (const int error = move_names(names, final_, staging_); error != 0) fail(shown_, error);
  } else if (const int error = rename_to(resumed, staging_); error != 0) {
    fail(shown_, error);
  }
}

/// Removes what was added to unfinished results since, as a page that shows them.
void OutputFolder::remove_added() {
  const auto is_of_writer = [this](const FileRecord& file) {
    return std::any_of(names_.begin(), names_.end(), [&](const std::string& name) {
      return name.ends_with('*') ? file.name.starts_with(name.substr(0, name.size() - 1)) : file.name == name;
    });
  };
  for (const FileRecord& file : read_manifest(staging_).value_or(Manifest{}).files)
    if (!is_of_writer(file)) fs::remove(staging_ / file.name);
}

std::string OutputFolder::taken_by_another() const {
  return "cannot write into " + shown_.string() + ": another run is writing it";
}

/// No other run holds the final folder, since this one holds the staging folder. Who adds a line to its manifest is
/// waited for.
void OutputFolder::lock_final() {
  constexpr auto most = std::chrono::minutes(1);
  if (is_folder(final_) && !final_lock_.wait(final_, most) && is_folder(final_))
    throw std::runtime_error(taken_by_another());
}

/// Makes the staging folder and locks it. Another process that holds it may end in the meantime and remove it. A second
/// is waited for one that was killed: the worker of a batch lets go of its journal, so that the next batch begins, some
/// time before it lets go of the folder of its case.
void OutputFolder::claim_staging() {
  constexpr int most_tries = 50;
  for (int k = 0; k < most_tries; ++k) {
    if (::mkdir(staging_.c_str(), 0777) != 0 && errno != EEXIST) fail(shown_, errno);
    if (lock_.take(staging_)) return;
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  throw std::runtime_error(taken_by_another());
}

OutputFolder::~OutputFolder() {
  if (is_whole_) return;
  try {
    remove_listed(staging_);
  } catch (const std::exception&) {  // the next writer removes it
  }
}

/// Cleans up after writers that were killed, including one that moved entries because it was inside the final folder.
void OutputFolder::settle_former_staging() {
  const fs::path inner = final_ / inner_name;
  if (!is_in_place_ && is_folder(inner)) {
    FolderLock lock;
    if (!lock.take(inner)) throw std::runtime_error(taken_by_another());
    settle(inner, final_);
  }
  if (fs::is_empty(staging_)) return;
  keep_of_killed();
  if (is_folder(staging_)) settle(staging_, final_);
  claim_staging();
}

/// What a run that was killed had recorded is kept beside the folder, as failed results under a name of their own, and
/// so is not removed by the next run. A case of a batch runs again, and its batch keeps what it needs.
void OutputFolder::keep_of_killed() {
  if (!owner_.key.empty() || !has_lines_of_killed(staging_, 2)) return;
  const fs::path parent = can_move_to(staging_, final_.parent_path()) ? final_.parent_path() : final_;
  fs::path place = parent / (final_.filename().string() + ".failed");
  for (int k = 2; fs::exists(fs::symlink_status(place)); ++k)
    place = parent / (final_.filename().string() + ".failed." + std::to_string(k));
  publish_rows_of_killed(staging_, place, final_.filename().string());
  kept_of_killed_ = place;
}

fs::path OutputFolder::keep_of_killed(const fs::path& folder, const Owner& owner) {
  const fs::path final = resolved(folder), staging = staging_of(folder);
  FolderLock lock;
  if (!lock.take(staging) || !has_lines_of_killed(staging, 1)) return {};
  fs::path place = final;
  if (is_folder(final)) {
    require_ours(final, owner);
    const std::optional<Manifest> former = read_manifest(final);
    const bool is_good = former && former->state == FolderState::good;
    if (is_good) place += ".failed";
    if (is_folder(place)) remove_whole(place);  // an earlier failed attempt
  }
  publish_rows_of_killed(staging, place, place == final ? "" : final.filename().string());
  return place == final ? folder : place;
}

/// Lists the files from the start, in case the run is killed.
void OutputFolder::prepare_staging() {
  Manifest planned = manifest();
  for (const std::string& name : names_) planned.files.push_back({name});
  write_file(staging_ / manifest_name, manifest_text(planned), Durability::later);
}

void OutputFolder::write(const std::string& name, std::string_view text) {
  write_file(staging_ / name, text, Durability::soon);
  add({name, text.size(), digest_of(text)});
}

void OutputFolder::write_index(const std::string& name, std::string_view text) {
  write(name, text);
  index_ = name;
}

/// Removes what cannot be made durable: the system may have dropped the data, and a second fsync would not report this.
void OutputFolder::make_durable() {
  std::exception_ptr failure;
  std::error_code ignored;
  std::vector<fs::path> folders;
  for (const FileRecord& file : files_) {
    const fs::path path = staging_ / file.name, within = path.parent_path();
    if (within != staging_ && std::find(folders.begin(), folders.end(), within) == folders.end())
      folders.push_back(within);
    try {
      sync_file(path);
    } catch (const std::runtime_error&) {
      if (!failure) failure = std::current_exception();
      fs::remove(path, ignored);
    }
  }
  if (failure && !index_.empty()) fs::remove(staging_ / index_, ignored);
  if (failure) std::rethrow_exception(failure);
  for (const fs::path& folder : folders) sync_directory(folder);
}

/// The first name beside the final folder that is free, or whose folder holds an earlier failed run of these results.
fs::path OutputFolder::place_beside() const {
  constexpr int most = 1000;
  const fs::path parent = can_move_to(staging_, final_.parent_path()) ? final_.parent_path() : final_;
  for (int k = 1; k < most; ++k) {
    const fs::path place = parent / (final_.filename().string() + ".failed" + (k > 1 ? "." + std::to_string(k) : ""));
    if (!fs::exists(fs::symlink_status(place))) return place;
    const std::optional<Manifest> there = is_folder(place) ? read_manifest(place) : std::nullopt;
    if (there && there->instead_of == final_.filename().string() && foreign_entries(place, 1).empty()) return place;
  }
  throw std::runtime_error("cannot write beside " + shown_.string() + ": too many folders of failed runs");
}

/// Why the results cannot replace what exists under the final name; empty if they can.
std::string OutputFolder::obstacle(FolderState state) const {
  if (!is_folder(final_)) return {};
  const std::optional<Manifest> former = read_manifest(final_);
  if (!foreign_entries(final_, former, 1).empty()) return "holds files now that bough did not write";
  const bool is_same = former && former->key == owner_.key;
  const bool would_lose = is_same && former->state == FolderState::good && state != FolderState::good;
  return would_lose ? "holds good results, which are kept" : "";
}

Manifest OutputFolder::manifest() const { return manifest_of(owner_, final_); }

void OutputFolder::publish(FolderState state) {
  std::exception_ptr failure;
  try {
    Manifest whole = manifest();
    whole.state = state;
    if (!obstacle(state).empty()) whole.instead_of = final_.filename().string();
    whole.files = files_;
    AtomicFile file(staging_ / manifest_name);
    file.write(manifest_text(whole));
    file.start_writing_out();
    make_durable();
    file.commit(Durability::content);  // a manifest with hashes is committed only after the files that it lists
    sync_directory(staging_);
  } catch (...) {  // the disk is full: the files remain listed as unfinished in the manifest made at the start
    failure = std::current_exception();
    state = FolderState::unfinished;
  }
  is_whole_ = true;
  obstacle_ = obstacle(state);
  try {
    const fs::path target = stands_beside() ? place_beside() : final_;
    replace_final(target);
    sync_directory(target.parent_path());
    if (stands_beside()) shown_ = shown_.is_absolute() ? target : target.lexically_proximate(fs::current_path());
  } catch (const std::exception& error) {
    throw std::runtime_error(std::string(error.what()) + "; what was computed stands in " + staging_.string());
  }
  if (failure) std::rethrow_exception(failure);
}

void OutputFolder::replace_final(const fs::path& target) {
  if (!is_folder(target)) {
    if (const int error = rename_to(staging_, target); error != 0) fail(target, error);
    return;
  }
  if (is_in_place_ && target == final_) return move_entries(target);
  std::vector<std::string> guests = guests_of(target);
  if (is_of_another(target, owner_)) guests.clear();  // they belong to the former results
  if (const int error = move_names(guests, target, staging_); error != 0) {
    (void)move_names(guests, staging_, target);
    fail(target, error);
  }
  if (const int error = exchange(staging_, target); error != 0) {
    if (const int back = move_names(guests, staging_, target); back != 0) fail(target, back);
    return move_entries(target);
  }
  try {
    remove_whole(staging_);          // the former results
  } catch (const std::exception&) {  // the new results are in place; the next writer removes the former ones
  }
}

/// Moves the former entries out and the new ones in, manifests first and last. If one cannot be moved, all moves are
/// undone.
void OutputFolder::move_entries(const fs::path& target) {
  const fs::path former = staging_ / former_name;
  if (::mkdir(former.c_str(), 0777) != 0 && errno != EEXIST) fail(target, errno);
  const std::vector<std::string> out = top_names(target);
  std::vector<std::string> in = top_names(staging_);
  std::rotate(in.begin(), in.begin() + 1, in.end());
  std::vector<std::pair<fs::path, fs::path>> moved;
  const auto move = [&](const fs::path& from, const fs::path& to) {
    if (const int error = rename_to(from, to); error != 0) {
      for (auto back = moved.rbegin(); back != moved.rend(); ++back) (void)rename_to(back->second, back->first);
      fs::remove(former);
      fail(target, error);
    }
    moved.emplace_back(from, to);
  };
  for (const std::string& name : out)
    if (target / name != staging_) move(target / name, former / name);
  for (const std::string& name : in) move(staging_ / name, target / name);
  sync_directory(target);
  try {
    if (!out.empty()) remove_listed(former);
    fs::remove(former);
    fs::remove(staging_);
  } catch (const std::exception&) {  // the new results are in place; the next writer removes the former ones
  }
}

namespace {

/// Where the former results of a folder stand while new ones are written.
fs::path former_of(const fs::path& folder) { return folder.parent_path() / (folder.filename().string() + ".former"); }

bool is_former_of(const fs::path& former, const fs::path& folder) {
  const std::optional<Manifest> manifest = read_manifest(former);
  return manifest && manifest->instead_of == folder.filename().string();
}

}  // namespace

OutputCollection::OutputCollection(fs::path folder, Owner owner, const std::vector<fs::path>& inputs, Writers writers)
    : folder_(std::move(folder)), owner_(std::move(owner)), writers_(writers) {
  refuse_inputs_within(inputs, folder_);
  require_ours(folder_, owner_);
  std::error_code error;
  fs::create_directories(folder_, error);
  if (error) throw std::runtime_error("cannot make the directory " + folder_.string() + ": " + error.message());
  if (writers_ == Writers::one) claim();
}

/// Locks the folder. A run that is to replace it holds its staging folder, which is taken first, therefore. Workers of a
/// batch that was killed are waited for: one that has called fsync ends only when the disk has answered.
void OutputCollection::claim() {
  constexpr auto most = std::chrono::seconds(6);
  const fs::path final = resolved(folder_), staging = OutputFolder::staging_of(folder_);
  const bool may_stage = ::mkdir(staging.c_str(), 0777) == 0 || errno == EEXIST;
  struct Staging {
    ~Staging() {
      if (std::error_code ignored; fs::is_empty(path, ignored)) fs::remove(path, ignored);
    }
    fs::path path;
    FolderLock lock = {};
  } run{may_stage ? staging : fs::path()};
  if ((may_stage && !run.lock.wait(staging, most)) || !lock_.wait(final, most))
    throw OutputRefused("another run or batch writes into " + folder_.string());
  require_ours(folder_, owner_);
  if (owner_.replaces) set_aside(final);
  Manifest manifest = manifest_of(owner_, folder_);
  if (const std::optional<Manifest> former = read_manifest(folder_))
    for (const FileRecord& file : former->files) manifest.files.push_back({file.name});
  write_file(folder_ / manifest_name, manifest_text(manifest), Durability::later);
}

/// The former results go to <name>.former as a whole, and stay there until the new ones are complete; those of an
/// attempt that was not completed are removed. Where the folder cannot be renamed, the former results are removed.
void OutputCollection::set_aside(const fs::path& final) {
  std::optional<Manifest> manifest = read_manifest(final);
  const fs::path former = former_of(final);
  if (is_folder(former) && !is_former_of(former, final))
    throw OutputRefused("the results in " + folder_.string() + " would be kept as " + former.string() +
                        " until the new ones are complete, and that is another folder: move it away");
  if (!manifest) return;
  if (is_folder(former) && manifest->state == FolderState::good) remove_whole(former);
  if (is_folder(former) || has_to_stay(final)) return remove_whole_within(final);
  manifest->instead_of = final.filename().string();
  write_file(final / manifest_name, manifest_text(*manifest), Durability::later);
  lock_.release();  // the lock of the staging folder keeps others away
  if (const int error = rename_to(final, former); error != 0) fail(folder_, error);
  fs::create_directories(final);
  if (!lock_.take(final)) throw OutputRefused("another run or batch writes into " + folder_.string());
}

std::optional<fs::path> OutputCollection::publish(FolderState state) {
  std::optional<Manifest> manifest = read_manifest(folder_);
  // One that is there and cannot be read, for want of descriptors, lists what a new one would not.
  if (!manifest && fs::exists(fs::symlink_status(folder_ / manifest_name)))
    throw std::runtime_error("cannot read " + (folder_ / manifest_name).string());
  if (!manifest) manifest = manifest_of(owner_, folder_);
  manifest->state = state;
  for (FileRecord& file : manifest->files)
    for (const FileRecord& written : written_)
      if (written.name == file.name) file = written;
  write_file(folder_ / manifest_name, manifest_text(*manifest));
  const fs::path final = resolved(folder_), former = former_of(final);
  if (!is_folder(former) || !is_former_of(former, final)) return std::nullopt;
  if (state == FolderState::good) remove_whole(former);
  return is_folder(former) ? std::optional(former) : std::nullopt;
}

void OutputCollection::record(FileRecord record) {
  const auto at = std::find_if(written_.begin(), written_.end(),
                               [&](const FileRecord& former) { return former.name == record.name; });
  if (at == written_.end())
    written_.push_back(std::move(record));
  else
    *at = std::move(record);
}

void OutputCollection::write(const std::string& name, std::string_view text) {
  write(name, [text](const TextSink& sink) { sink(text); });
}

void OutputCollection::write(const std::string& name, const TextWriter& writer) {
  list(name);
  AtomicFile file(folder_ / name);
  writer([&file](std::string_view text) { file.write(text); });
  file.commit();
  record({name, file.bytes_flushed(), file.digest()});
}

void OutputCollection::write_once(const std::string& name, std::string_view text) {
  if (writers_ == Writers::many)
    write_listed_file_once(folder_, owner_, name, text);
  else if (!fs::exists(folder_ / name))
    write(name, text);
}

void OutputCollection::list(const std::string& name) {
  if (writers_ == Writers::many)
    list_file(folder_, owner_, name);
  else
    list_file_in_locked(folder_, owner_, name);
}

}  // namespace bough::io
