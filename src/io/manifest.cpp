#include "bough/io/manifest.hpp"

#include <algorithm>
#include <chrono>
#include <iterator>

#include "bough/io/atomic_file.hpp"
#include "bough/io/digest.hpp"
#include "bough/io/folder_lock.hpp"
#include "bough/io/input_file.hpp"
#include "bough/io/json_text.hpp"
#include "bough/io/json_value.hpp"
#include "bough/io/number_text.hpp"
#include "bough/io/output_folder.hpp"

namespace bough::io {
namespace {

namespace fs = std::filesystem;

constexpr const char* format_name = "bough folder 1";
constexpr std::string_view partial_ending = ".partial";

const char* text_of(FolderState state) {
  switch (state) {
    case FolderState::unfinished:
      return "unfinished";
    case FolderState::good:
      return "good";
    case FolderState::failed:
      return "failed";
  }
  return "unfinished";
}

std::string text_at(const JsonValue& object, std::string_view key) {
  const JsonValue* value = object.find(key);
  return value != nullptr && value->is(JsonKind::string) ? value->text : std::string();
}

/// True for a relative name that stays below its folder.
bool is_below(const std::string& name) {
  const fs::path path(name);
  return !name.empty() && path.is_relative() &&
         std::none_of(path.begin(), path.end(), [](const fs::path& part) { return part == ".." || part == "."; });
}

bool read_files(const JsonValue& list, std::vector<FileRecord>& files) {
  for (std::size_t k = 0; k < list.items.size(); ++k) {
    const JsonValue& item = list.items[k];
    FileRecord record{list.items.key(k)};
    if (!is_below(record.name)) return false;
    if (const JsonValue* bytes = item.find("bytes"); bytes != nullptr)
      record.bytes = whole_number<std::uint64_t>(bytes->number);
    record.hash = text_at(item, "hash");
    files.push_back(std::move(record));
  }
  return true;
}

bool is_named(const FileRecord& record, std::string_view name) {
  if (record.name.ends_with('*')) return name.starts_with(record.name.substr(0, record.name.size() - 1));
  return record.name == name;
}

/// Looks up names among the records of a manifest.
class Listed {
 public:
  explicit Listed(const Manifest& manifest) : records_(manifest.files) {
    std::sort(records_.begin(), records_.end(),
              [](const FileRecord& a, const FileRecord& b) { return a.name < b.name; });
    std::copy_if(records_.begin(), records_.end(), std::back_inserter(stars_),
                 [](const FileRecord& r) { return r.name.ends_with('*'); });
  }
  const FileRecord* find(std::string_view name) const {
    const auto at = std::lower_bound(records_.begin(), records_.end(), name,
                                     [](const FileRecord& r, std::string_view n) { return r.name < n; });
    if (at != records_.end() && at->name == name) return &*at;
    const auto star =
        std::find_if(stars_.begin(), stars_.end(), [&](const FileRecord& r) { return is_named(r, name); });
    return star == stars_.end() ? nullptr : &*star;
  }
  /// Whether a file can be regarded as one that bough wrote.
  bool holds(const fs::directory_entry& entry, std::string name) const {
    if (entry.is_symlink() || !entry.is_regular_file()) return false;
    if (name == manifest_name) return true;
    const bool is_partial = name.ends_with(partial_ending);
    if (is_partial) name.resize(name.size() - partial_ending.size());
    if (is_partial && name == manifest_name) return true;
    const FileRecord* record = find(name);
    if (record == nullptr || is_partial || record->hash.empty()) return record != nullptr;
    return entry.file_size() == record->bytes && digest_of_file(entry.path()) == record->hash;
  }
  /// Whether a listed file lies below the folder.
  bool has_below(const std::string& folder) const {
    return std::any_of(records_.begin(), records_.end(),
                       [&](const FileRecord& r) { return r.name.starts_with(folder + "/"); });
  }

 private:
  std::vector<FileRecord> records_, stars_;
};

/// Whether a folder is empty, or contains only files left by a writer that was killed before its first manifest was
/// named.
bool has_no_content(const fs::path& folder) {
  const std::string unfinished = std::string(manifest_name) + ".partial";
  return std::all_of(fs::directory_iterator(folder), fs::directory_iterator(), [&](const fs::directory_entry& entry) {
    return !entry.is_symlink() && entry.is_regular_file() && entry.path().filename() == unfinished;
  });
}

void look_below(const fs::path& folder, const std::string& prefix, const Listed& listed, std::size_t limit,
                std::vector<std::string>& foreign) {
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    if (foreign.size() >= limit) return;
    const std::string name = prefix + entry.path().filename().string();
    if (!entry.is_symlink() && entry.is_directory()) {
      if (listed.has_below(name))
        look_below(entry.path(), name + "/", listed, limit, foreign);
      else if (!read_manifest(entry.path()) && !has_no_content(entry.path()))
        foreign.push_back(name + "/");
    } else if (!listed.holds(entry, name)) {
      foreign.push_back(name);
    }
  }
}

/// Removes listed files below a folder, and folders that become empty.
void remove_below(const fs::path& folder, const std::string& prefix, const Listed& listed) {
  std::vector<fs::directory_entry> entries;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) entries.push_back(entry);
  for (const fs::directory_entry& entry : entries) {
    const std::string name = prefix + entry.path().filename().string();
    if (!entry.is_symlink() && entry.is_directory()) {
      if (listed.has_below(name)) remove_below(entry.path(), name + "/", listed);
    } else if (name != manifest_name && listed.holds(entry, name)) {
      fs::remove(entry.path());
    }
  }
  if (!prefix.empty() && fs::is_empty(folder)) fs::remove(folder);
}

/// One form for all paths to a place: resolved as far as it exists.
fs::path place_of(const fs::path& path) {
  std::error_code error;
  const fs::path place = fs::weakly_canonical(fs::absolute(path), error).lexically_normal();
  return error ? fs::absolute(path).lexically_normal() : place;
}

bool are_one(const fs::path& a, const fs::path& b) {
  std::error_code error;
  return place_of(a) == place_of(b) || fs::equivalent(a, b, error);
}

/// Whether a run writes this folder as a whole: it holds its staging folder, too, to its end.
bool is_held_by_run(const fs::path& folder) {
  const fs::path staging = OutputFolder::staging_of(folder);
  std::error_code ignored;
  if (!fs::is_directory(fs::symlink_status(staging, ignored))) return false;
  FolderLock lock;
  return !lock.take(staging) && fs::exists(fs::symlink_status(staging, ignored));
}

/// Waits for a folder's lock. Who holds it for a line of its manifest, a thread of this process or another process, lets
/// go of it by itself, however long a busy machine or disk lets that take. A run that holds the folder to its end is not
/// waited for.
void wait_for(FolderLock& lock, const fs::path& folder) {
  constexpr int most_seconds = 1800;  // a process that was stopped may never let go
  for (int k = 0; !lock.wait(fs::canonical(folder), std::chrono::seconds(1)); ++k)
    if (k == most_seconds || is_held_by_run(folder))
      throw std::runtime_error("cannot write into " + folder.string() + ": another run is writing it");
}

}  // namespace

Manifest manifest_of(const Owner& owner, const fs::path& folder) {
  Manifest manifest{owner.verb};
  const bool is_file = !owner.source.empty() && owner.source != "-";
  manifest.source =
      is_file ? place_of(owner.source).lexically_relative(place_of(folder)).string() : owner.source.string();
  manifest.key = owner.key;
  return manifest;
}

std::string manifest_text(const Manifest& manifest) {
  JsonText json;
  json.begin_object();
  json.member("format", std::string_view(format_name));
  json.member("made_by", std::string_view(manifest.made_by));
  json.member("state", std::string_view(text_of(manifest.state)));
  if (!manifest.instead_of.empty()) json.member("instead_of", std::string_view(manifest.instead_of));
  if (!manifest.source.empty()) json.member("source", std::string_view(manifest.source));
  if (!manifest.key.empty()) json.member("key", std::string_view(manifest.key));
  json.key("files");
  json.begin_object();
  for (const FileRecord& file : manifest.files) {
    json.key(file.name);
    json.begin_object();
    if (!file.hash.empty()) {
      json.member("bytes", static_cast<long long>(file.bytes));
      json.member("hash", std::string_view(file.hash));
    }
    json.end_object();
  }
  json.end_object();
  json.end_object();
  return json.text();
}

std::optional<Manifest> read_manifest(const fs::path& folder) {
  const fs::path path = folder / manifest_name;
  std::error_code ignored;
  if (!fs::is_regular_file(fs::symlink_status(path, ignored))) return std::nullopt;
  std::vector<JsonFault> faults;
  std::optional<JsonValue> json;
  try {
    json = parse_json(read_text(path, max_file_bytes), source_file, faults);
  } catch (const Unreadable&) {
    return std::nullopt;
  }
  if (!json || !json->is(JsonKind::object) || text_at(*json, "format") != format_name) return std::nullopt;
  Manifest manifest{text_at(*json, "made_by")};
  for (const FolderState state : {FolderState::good, FolderState::failed})
    if (text_at(*json, "state") == text_of(state)) manifest.state = state;
  manifest.instead_of = text_at(*json, "instead_of");
  manifest.source = text_at(*json, "source");
  manifest.key = text_at(*json, "key");
  const JsonValue* files = json->find("files");
  if (files == nullptr || !read_files(*files, manifest.files)) return std::nullopt;
  return manifest;
}

std::vector<std::string> foreign_entries(const fs::path& folder, std::size_t limit) {
  return foreign_entries(folder, read_manifest(folder), limit);
}

std::vector<std::string> foreign_entries(const fs::path& folder, const std::optional<Manifest>& manifest,
                                         std::size_t limit) {
  std::vector<std::string> foreign;
  const Listed listed(manifest.value_or(Manifest{}));
  if (!manifest && fs::exists(fs::symlink_status(folder / manifest_name))) foreign.emplace_back(manifest_name);
  look_below(folder, "", listed, limit, foreign);
  std::sort(foreign.begin(), foreign.end());
  return foreign;
}

void remove_listed(const fs::path& folder) {
  const std::optional<Manifest> manifest = read_manifest(folder);
  if (!manifest && !fs::is_empty(folder)) return;
  if (manifest) {
    remove_below(folder, "", Listed(*manifest));
    bool is_bare = true;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder))
      is_bare = is_bare && entry.path().filename() == manifest_name;
    if (!is_bare) return;
    fs::remove(folder / manifest_name);
  }
  fs::remove(folder);
}

std::vector<fs::path> listed_folders(const fs::path& folder) {
  std::vector<fs::path> folders;
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    std::error_code unknown;
    if (!it->is_symlink(unknown) && it->is_directory(unknown) && read_manifest(it->path()))
      folders.push_back(it->path());
  }
  std::sort(folders.begin(), folders.end());
  return folders;
}

void remove_whole_within(const fs::path& folder) {
  for (const fs::path& one : listed_folders(folder)) remove_whole(one);
  if (const std::optional<Manifest> manifest = read_manifest(folder)) remove_below(folder, "", Listed(*manifest));
}

void remove_whole(const fs::path& folder) {
  remove_whole_within(folder);
  remove_listed(folder);
}

namespace {

[[noreturn]] void refuse_foreign(const fs::path& folder, const std::vector<std::string>& foreign) {
  std::string names;
  for (const std::string& name : foreign) names += (names.empty() ? "" : ", ") + name;
  throw OutputRefused("results go into a folder of their own, and " + folder.string() +
                      " holds what bough did not write, or what was changed since: " + names +
                      "; give --out a new name, or move these away");
}

/// Whether results in a folder are not those of an owner. The cases of a batch are all owned by it.
bool is_of_another(const Manifest& there, const Manifest& wanted) {
  if (there.made_by != wanted.made_by || there.key.empty() != wanted.key.empty()) return true;
  return wanted.key.empty() && !there.source.empty() && !wanted.source.empty() && there.source != wanted.source;
}

std::string in_words(const Manifest& manifest, const fs::path& folder) {
  if (!manifest.key.empty()) return "a case of a batch";
  const bool is_file = !manifest.source.empty() && manifest.source != "-";
  return "bough " + manifest.made_by +
         (is_file ? " of " + place_of(folder / manifest.source).lexically_proximate(fs::current_path()).string() : "");
}

}  // namespace

bool is_of_another(const fs::path& folder, const Owner& owner) {
  const std::optional<Manifest> manifest = read_manifest(folder);
  return manifest && is_of_another(*manifest, manifest_of(owner, folder));
}

void require_ours(const fs::path& folder, const Owner& owner) {
  const fs::file_status there = fs::symlink_status(folder);
  if (!fs::exists(there)) return;
  if (!fs::is_directory(fs::status(folder)))
    throw std::runtime_error("cannot write into " + folder.string() + ": not a directory");
  const std::optional<Manifest> manifest = read_manifest(folder);
  const std::vector<std::string> foreign = foreign_entries(folder, manifest, 3);
  if (!foreign.empty()) refuse_foreign(folder, foreign);
  const Manifest wanted = manifest_of(owner, folder);
  if (owner.replaces) {
    for (const fs::path& one : listed_folders(folder)) require_ours(one, owner);
  } else if (manifest && is_of_another(*manifest, wanted)) {
    throw OutputRefused(folder.string() + " holds results of " + in_words(*manifest, folder) + ", and " +
                        in_words(wanted, folder) +
                        " would replace them: give --out another name, or allow that with --replace");
  }
}

bool repair_manifest(const fs::path& folder, const Owner& owner, const std::vector<std::string>& names) {
  const fs::path path = folder / manifest_name;
  if (read_manifest(folder) || fs::symlink_status(path).type() != fs::file_type::regular) return false;
  Manifest manifest = manifest_of(owner, folder);
  for (const std::string& name : names) manifest.files.push_back({name});
  write_file(path, manifest_text(manifest));
  return true;
}

void refuse_to_overwrite(const std::vector<fs::path>& inputs, const std::vector<fs::path>& outputs) {
  for (std::size_t k = 0; k < outputs.size(); ++k) {
    if (outputs[k].empty()) continue;
    for (const fs::path& input : inputs)
      if (!input.empty() && input != "-" && are_one(input, outputs[k]))
        throw OutputRefused(outputs[k].string() +
                            " is read here and would be overwritten: give the output another name");
    for (std::size_t other = 0; other < k; ++other)
      if (!outputs[other].empty() && are_one(outputs[other], outputs[k]))
        throw OutputRefused("two outputs go to " + outputs[k].string() + ": give one of them another name");
  }
}

void refuse_inputs_within(const std::vector<fs::path>& inputs, const fs::path& folder) {
  const fs::path place = place_of(folder);
  for (const fs::path& input : inputs) {
    if (input.empty() || input == "-") continue;
    const fs::path inside = place_of(input).lexically_relative(place);
    if (!inside.empty() && *inside.begin() != "..")
      throw OutputRefused(input.string() + " is read here and lies in the folder " + folder.string() +
                          ", which the results replace: give --out another name");
  }
}

void list_file_in_locked(const fs::path& folder, const Owner& owner, const std::string& name) {
  std::optional<Manifest> present = read_manifest(folder);
  if (!present && fs::exists(fs::symlink_status(folder / manifest_name)))
    throw OutputRefused((folder / manifest_name).string() + " was not written by bough and would be replaced");
  Manifest manifest = present ? std::move(*present) : manifest_of(owner, folder);
  if (!present) manifest.state = FolderState::good;
  const auto at = std::find_if(manifest.files.begin(), manifest.files.end(),
                               [&](const FileRecord& record) { return record.name == name; });
  if (at != manifest.files.end() && at->hash.empty()) return;
  if (at != manifest.files.end())
    *at = {name};
  else
    manifest.files.push_back({name});
  write_file(folder / manifest_name, manifest_text(manifest), Durability::later);
}

void list_file(const fs::path& folder, const Owner& owner, const std::string& name) {
  FolderLock lock;
  wait_for(lock, folder);
  list_file_in_locked(folder, owner, name);
}

void write_listed_file_once(const fs::path& folder, const Owner& owner, const std::string& name,
                            std::string_view text) {
  if (fs::exists(folder / name)) return;
  FolderLock lock;
  wait_for(lock, folder);
  if (fs::exists(folder / name)) return;
  list_file_in_locked(folder, owner, name);
  write_file(folder / name, text);
}

void write_listed_file(const fs::path& folder, const Owner& owner, const std::string& name, std::string_view text) {
  list_file(folder, owner, name);
  write_file(folder / name, text);
}

}  // namespace bough::io
