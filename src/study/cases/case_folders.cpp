#include "bough/study/case_folders.hpp"

#include <algorithm>
#include <system_error>
#include <unordered_map>

#include "bough/io/csv_table.hpp"
#include "bough/io/folder_lock.hpp"
#include "bough/io/input_file.hpp"
#include "bough/io/manifest.hpp"
#include "bough/study/collect.hpp"

namespace bough::study {
namespace {

namespace fs = std::filesystem;

/// The key of a name by the keys.csv of a folder; none: there is no such file, or no such name in it.
std::optional<std::string> key_in(const fs::path& batch, const std::string& name) {
  if (std::error_code ignored; !fs::exists(batch / keys_file, ignored)) return std::nullopt;
  io::CsvTable keys;
  if (!keys.read(io::read_text(batch / keys_file)).empty() || keys.columns.size() != 2) return std::nullopt;
  for (const std::vector<std::string>& row : keys.rows)
    if (row[0] == name) return row[1];
  return std::nullopt;
}

bool is_good(const CaseResult& result) {
  return result.status == CaseStatus::ok || result.status == CaseStatus::figures_fail;
}

bool is_taken(const fs::path& place) {
  std::error_code ignored;
  return fs::exists(fs::symlink_status(place, ignored));
}

/// The first of place, place.2, place.3, ... that is free.
fs::path free_place(const fs::path& place) {
  fs::path free = place;
  for (int k = 2; is_taken(free); ++k) free = place.string() + "." + std::to_string(k);
  return free;
}

/// Removes the folders of writers that were killed before they had listed anything in them, or after they had removed
/// all of it. Who still writes holds a lock.
void remove_bare_staging(const fs::path& batch) {
  std::error_code ignored;
  std::vector<fs::path> bare;
  for (fs::directory_iterator it(batch, ignored), end; !ignored && it != end; it.increment(ignored)) {
    const std::string name = it->path().filename().string();
    std::error_code unknown;
    if (!name.starts_with(".") || !name.ends_with(".bough-new") || !it->is_directory(unknown)) continue;
    if (!io::read_manifest(it->path())) bare.push_back(it->path());
  }
  for (const fs::path& folder : bare) {
    io::FolderLock lock;
    if (!lock.take(folder)) continue;
    fs::remove(folder / (std::string(io::manifest_name) + ".partial"), ignored);
    fs::remove(folder, ignored);  // if nothing else is in it
  }
}

}  // namespace

std::optional<FoundCase> find_case(const fs::path& folder, const std::string& name) {
  std::vector<fs::path> batches = {folder};
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder, ignored))
    if (fs::exists(entry.path() / shard_file, ignored)) batches.push_back(entry.path());
  std::optional<FoundCase> found;
  for (const fs::path& batch : batches) {
    const std::optional<std::string> key = key_in(batch, name);
    if (!key || (found && found->result)) continue;
    found = FoundCase{batch, *key, std::nullopt};
    for_each_record(batch / journal_file, [&](const std::string& of, const CaseResult& result, std::string_view) {
      if (of == found->key) found->result = result;
    });
  }
  return found;
}

std::string why_not_of_its_case(const fs::path& folder) {
  const std::optional<io::Manifest> manifest = io::read_manifest(folder);
  if (!manifest || manifest->key.empty()) return {};
  const fs::path place = fs::absolute(folder).lexically_normal();
  const fs::path named = place.has_filename() ? place : place.parent_path();
  const std::string name = manifest->instead_of.empty() ? named.filename().string() : manifest->instead_of;
  const std::optional<FoundCase> found = find_case(named.parent_path(), name);
  if (!found && !is_taken(named.parent_path() / keys_file)) return {};  // it was taken out of its batch
  if (found && found->key == manifest->key) return {};
  return folder.string() + " holds results of another case than that which is called " + name +
         (found ? " now" : ", which the batch no longer has") + ": the same command with --resume puts that right";
}

bool holds_case(const fs::path& folder, const std::string& key, const CaseResult& result) {
  const std::optional<io::Manifest> manifest = io::read_manifest(folder);
  return manifest && manifest->key == key && (manifest->state == io::FolderState::good) == is_good(result);
}

std::optional<fs::path> remove_case(const fs::path& folder) {
  const std::optional<io::Manifest> manifest = io::read_manifest(folder);
  if (!manifest || manifest->key.empty()) return std::nullopt;
  if (io::foreign_entries(folder, manifest, 1).empty()) io::remove_listed(folder);
  if (!is_taken(folder)) return std::nullopt;
  const fs::path aside = free_place(folder.string() + ".former");
  fs::rename(folder, aside);
  return aside;
}

std::vector<fs::path> settle_case_folders(const fs::path& batch, const CaseList& cases, const Records& records) {
  std::vector<fs::path> aside;
  remove_bare_staging(batch);
  const std::vector<fs::path> folders = io::listed_folders(batch);
  if (folders.empty()) return aside;
  std::unordered_map<std::string, std::string> name_of;  // by key
  for (std::size_t i = 0; i < cases.size(); ++i) {
    BatchCase one = cases.at(i);
    name_of.emplace(std::move(one.key), std::move(one.name));
  }
  // All that are misplaced leave their names before any of them takes its own, since names may be exchanged.
  std::vector<std::pair<fs::path, fs::path>> moves;
  for (const fs::path& folder : folders) {
    const io::Manifest manifest = io::read_manifest(folder).value_or(io::Manifest{});
    if (manifest.key.empty()) continue;
    const auto name = name_of.find(manifest.key);
    const std::string own = folder.filename().string();
    const std::optional<CaseResult> result = records.find(manifest.key);
    const bool is_left = own.ends_with(".former");
    const bool is_of_result = result && is_final(*result) && holds_case(folder, manifest.key, *result);
    const bool is_open = !result || !is_final(*result);  // the case runs again, perhaps from a checkpoint there
    const bool is_staging = name != name_of.end() && own == "." + name->second + ".bough-new";
    const bool is_in_place = name != name_of.end() && (own == name->second || manifest.instead_of == name->second);
    if (is_left || (is_in_place && (is_of_result || is_open)) || (is_staging && is_open)) continue;
    if (name == name_of.end() || !is_of_result) {
      if (const auto left = remove_case(folder)) aside.push_back(*left);
      continue;
    }
    const fs::path between = free_place(batch / ("." + manifest.key + ".bough-new"));
    fs::rename(folder, between);
    moves.emplace_back(between, batch / name->second);
  }
  for (const auto& [from, to] : moves) {
    if (!is_taken(to))
      fs::rename(from, to);
    else if (const auto left = remove_case(from))
      aside.push_back(*left);
  }
  return aside;
}

}  // namespace bough::study
