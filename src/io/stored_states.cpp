#include "bough/io/stored_states.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

#include "bough/io/csv_table.hpp"
#include "bough/io/history.hpp"
#include "bough/io/input_file.hpp"
#include "bough/io/number_text.hpp"
#include "bough/io/output_folder.hpp"
#include "checkpoint_file.hpp"

namespace bough::io {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view first_line = "bough states 1";
constexpr double same_time = 1e-9;  ///< relative to the last time

struct Place {
  double time = 0.0;
  fs::path file;
  std::uint64_t offset = 0, bytes = 0;
  std::string hash;
};

/// The states of a file, by the lines before them. One that is not whole (a kill) does not count.
void list_states(const fs::path& path, std::vector<Place>& places, std::vector<std::string>& skipped) try {
  const InputFile file(path);
  const auto line_at = [&](std::uint64_t offset) {
    constexpr std::size_t longest = 200;
    std::string line(longest, '\0');
    line.resize(file.read(offset, line.data(), longest));
    const std::size_t end = line.find('\n');
    return end == std::string::npos ? std::string() : line.substr(0, end);
  };
  if (line_at(0) != first_line) {
    skipped.push_back(path.string() + " is no list of states that this version reads");
    return;
  }
  for (std::uint64_t offset = first_line.size() + 1; offset < file.size();) {
    const std::string line = line_at(offset);
    std::vector<std::string> words;
    double time = 0.0, bytes = 0.0;
    if (line.empty() || !split_csv_line(line, words) || words.size() != 3 || !read_number(words[0], time) ||
        !std::isfinite(time) || !read_number(words[1], bytes) ||
        !(bytes >= 0.0 && bytes <= static_cast<double>(file.size())))
      return;
    offset += line.size() + 1;
    const auto size = static_cast<std::uint64_t>(bytes);
    if (size > file.size() - offset) return;
    places.push_back({time, path, offset, size, words[2]});
    offset += size;
  }
} catch (const Unreadable& fault) {
  skipped.emplace_back(fault.what());
}

/// Empty where the bytes are not those that were written.
std::optional<records::StoredState> read_state(std::string_view bytes) try {
  records::Archive archive(bytes);
  records::StoredState state;
  archive(state);
  const auto is_finite = [](const auto& numbers) {
    return std::all_of(numbers.begin(), numbers.end(), [](double x) { return std::isfinite(x); });
  };
  const bool is_good =
      std::isfinite(state.time) && std::all_of(state.parts.begin(), state.parts.end(), [&](const auto& p) {
        return is_finite(p.position) && is_finite(p.rest) && is_finite(p.rotation) && is_finite(p.velocity) &&
               is_finite(p.angular_velocity);
      });
  if (!is_good) return std::nullopt;
  return state;
} catch (const std::runtime_error&) {
  return std::nullopt;
}

std::optional<FoundState> read_at(const Place& place) try {
  const InputFile file(place.file);
  std::string bytes(place.bytes, '\0');
  if (file.read(place.offset, bytes.data(), bytes.size()) != bytes.size() || digest_of(bytes) != place.hash)
    return std::nullopt;
  std::optional<records::StoredState> state = read_state(bytes);
  if (!state) return std::nullopt;
  return FoundState{std::move(*state), place.hash, place.file};
} catch (const Unreadable&) {
  return std::nullopt;
}

/// With the digits by which times are told apart.
std::string number(double x) { return rounded_text(x, 10); }

/// "There are 0.1, 0.2 and 0.3": the nearest ones, in the order of time.
std::string nearest_of(const std::vector<FoundState>& whole, const std::vector<Place>& places, double time) {
  constexpr std::size_t most = 5;
  std::vector<double> times;
  for (const FoundState& found : whole) times.push_back(found.state.time);
  for (const Place& place : places) times.push_back(place.time);
  std::sort(times.begin(), times.end());
  times.erase(std::unique(times.begin(), times.end()), times.end());
  const std::size_t all = times.size();
  std::stable_sort(times.begin(), times.end(),
                   [&](double a, double b) { return std::abs(a - time) < std::abs(b - time); });
  times.resize(std::min(most, times.size()));
  std::sort(times.begin(), times.end());
  std::string text;
  for (std::size_t i = 0; i < times.size(); ++i)
    text += (i == 0 ? "" : i + 1 == times.size() ? " and " : ", ") + number(times[i]);
  return (all > most ? "the nearest of " + std::to_string(all) + " are "
          : all == 1 ? "there is "
                     : "there are ") +
         text;
}

}  // namespace

void StateWriter::state(const records::StoredState& state) {
  if (!file_) {
    file_ = std::make_unique<AtomicFile>(path_);
    file_->write(std::string(first_line) + "\n");
  }
  records::Archive archive;
  records::StoredState copy = state;  // an archive reads and writes by the same function
  archive(copy);
  file_->write(number(state.time) + "," + std::to_string(archive.bytes().size()) + "," + digest_of(archive.bytes()) +
               "\n");
  file_->write(archive.bytes());
}

void StateWriter::checkpoint(records::Archive& archive) {
  bool is_begun = has_begun();
  archive(is_begun);
  if (!is_begun) return;
  if (archive.is_reading()) file_ = AtomicFile::reopen(path_);
  archive(*file_);
}

FoundState find_state(const fs::path& directory, std::optional<double> time, std::vector<std::string>& skipped) {
  std::error_code ignored;
  std::vector<Place> places;
  std::vector<FoundState> whole;
  bool is_there = false;
  for (const fs::path& folder : {directory, OutputFolder::staging_of(directory)}) {
    if (!fs::is_directory(folder, ignored)) continue;
    for (const char* name : {"states.bin", "states.bin.partial"})
      if (fs::exists(fs::symlink_status(folder / name, ignored))) list_states(folder / name, places, skipped);
    for (const char* name : {"checkpoint.1", "checkpoint.2"}) {
      if (!fs::exists(fs::symlink_status(folder / name, ignored))) continue;
      const CheckpointFile file = read_checkpoint_file(folder / name);
      std::optional<records::StoredState> state = file.fault.empty() ? read_state(file.state) : std::nullopt;
      if (state)
        whole.push_back({std::move(*state), digest_of(file.state), folder / name});
      else
        skipped.push_back((folder / name).string() +
                          " cannot be used: " + (file.fault.empty() ? "it is damaged" : file.fault));
    }
    is_there = true;
    if (!places.empty() || !whole.empty()) break;  // the staging folder counts where the folder itself has none
  }
  if (!is_there) throw NoSuchState(directory.string() + " is not a folder");
  if (places.empty() && whole.empty())
    throw NoSuchState(directory.string() + " holds no states of a run: neither states.bin nor a checkpoint");
  double last = 0.0;
  for (const Place& place : places) last = std::max(last, std::abs(place.time));
  for (const FoundState& found : whole) last = std::max(last, std::abs(found.state.time));
  const auto is_asked = [&](double t) { return !time || std::abs(t - *time) <= same_time * last; };
  const auto later = [](const auto& a, const auto& b) { return a.time < b.time; };
  std::sort(places.begin(), places.end(), later);
  std::optional<FoundState> best;
  for (auto place = places.rbegin(); place != places.rend() && !best; ++place) {
    if (!is_asked(place->time)) continue;
    best = read_at(*place);
    if (!best) skipped.push_back("the state of " + number(place->time) + " in " + place->file.string() + " is damaged");
  }
  for (FoundState& found : whole)
    if (is_asked(found.state.time) && (!best || found.state.time > best->state.time)) best = std::move(found);
  if (best) return std::move(*best);
  if (!time) throw NoSuchState(directory.string() + " holds no state that is whole");
  throw NoSuchState(directory.string() + " holds no state of " + number(*time) + ", and states are not interpolated; " +
                    nearest_of(whole, places, *time));
}

}  // namespace bough::io
