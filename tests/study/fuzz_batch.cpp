// libFuzzer target of what batches read: sweeps, journals, stores, records of shards, lists of cases. Anything may be
// refused; nothing may crash, hang or be taken for what it is not. The first byte says what the rest is. Lines of
// journals and records get the checksums that they need to be looked into.
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "bough/io/atomic_file.hpp"
#include "bough/io/digest.hpp"
#include "bough/io/read_sweep.hpp"
#include "bough/io/run_store.hpp"
#include "bough/study/cases.hpp"
#include "bough/study/collect.hpp"
#include "cases/case_report.hpp"
#include "support/batch_texts.hpp"

namespace {

using namespace bough;
namespace fs = std::filesystem;

/// A folder in memory that all inputs use.
const fs::path& scratch() {
  static const fs::path folder = [] {
    std::string pattern = fs::exists("/dev/shm") ? "/dev/shm/bough-fuzz-XXXXXX" : "/tmp/bough-fuzz-XXXXXX";
    if (mkdtemp(pattern.data()) == nullptr) std::abort();
    std::atexit([] {
      std::error_code ignored;
      fs::remove_all(scratch(), ignored);
    });
    return fs::path(pattern);
  }();
  return folder;
}

void write(const fs::path& file, std::string_view text) {
  FILE* out = std::fopen(file.c_str(), "wb");
  if (out == nullptr || std::fwrite(text.data(), 1, text.size(), out) != text.size()) std::abort();
  std::fclose(out);
}

void require(bool good) {
  if (!good) __builtin_trap();
}

constexpr std::string_view scene =
    R"({"schema_version": 1, "parameters": {"L": 1, "m": 2}, "gravity": [0, 0, -9.81],
"bodies": [{"name": "bob", "kind": "point_mass", "mass": {"expression": "m"}, "position": [{"expression": "L"}, 0, 0]}],
"joints": [{"name": "hinge", "kind": "revolute", "first": "ground", "second": "bob", "position": [0, 0, 0], "axis": [0, 1, 0]}],
"sensors": [{"name": "bob", "kind": "position", "at": "bob"}],
"analysis": {"kind": "dynamic", "end_time": 0.1, "step_size": 0.01}})";

void read_sweep(std::string_view text) {
  if (!fs::exists(scratch() / "scene.json")) write(scratch() / "scene.json", scene);
  const io::SweepFile file = io::read_sweep_text(text, "fuzz", scratch());
  for (const io::Problem& p : file.problems) require(!p.text().empty());
  if (!file.ok()) return;
  study::SweepCases cases;
  try {
    double samples = 1.0;
    for (const io::SweepDesign& d : file.spec.designs) samples *= 1.0 + d.samples;
    if (samples > 1e4) return;  // sound, and too many for an input
    cases = study::make_cases(file.spec);
  } catch (const std::runtime_error&) {
    return;
  }
  if (cases.size() > 1000) return;
  const std::string list = study::cases_csv(cases);
  require(study::adopt_cases(list, cases).empty());
  require(study::cases_csv(cases) == list);
}

/// Lines with the hash that a journal asks for.
std::string hashed(std::string_view text) {
  std::string lines;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    const std::string_view line = text.substr(begin, end - begin);
    lines += io::digest_of(line) + " " + std::string(line) + "\n";
    begin = end + 1;
  }
  return lines;
}

/// As it is, and with hashes.
void read_journal(std::string_view text) {
  const fs::path file = scratch() / "journal.jsonl";
  write(file, text);
  (void)study::read_records(file);
  write(file, hashed(text));
  std::string whole, again;
  std::vector<study::CaseResult> results;
  const auto take = [&](std::string& lines) {
    return [&](const std::string&, const study::CaseResult& result, std::string_view line) {
      lines += line;
      results.push_back(result);
    };
  };
  study::for_each_record(file, take(whole));
  const std::size_t count = results.size();
  write(file, whole);
  study::for_each_record(file, take(again));
  require(results.size() == 2 * count && again == whole);
  const study::CaseTable table(results);
  require(support::batch_csv(table) == support::batch_csv(results));
  for (std::size_t i = 0; i < count; ++i)
    require(study::text_of(table.at(i).report) == study::text_of(results[i].report));
  (void)support::batch_json(table, "fuzz");
}

void read_store(std::string_view text) {
  write(scratch() / "store_000.pack", text);
  for (const std::uint64_t offset : {std::uint64_t{0}, std::uint64_t{text.size() / 2}})
    if (const auto files = io::read_stored(scratch(), {"store_000.pack", offset}, ""))
      for (const io::StoredFile& file : *files) require(file.text.size() <= text.size());
}

/// Texts of cases.csv, shard.json, keys.csv and the journal, parted by form feeds. @ in the second is the hash of the
/// first.
void collect(std::string_view text) {
  const fs::path shards = scratch() / "shards", shard = shards / "shard_001_of_001";
  fs::create_directories(shard);
  std::vector<std::string> parts;
  for (int k = 0; k < 4; ++k) {
    const std::size_t end = std::min(text.find('\f'), text.size());
    parts.emplace_back(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  if (const std::size_t at = parts[1].find('@'); at != std::string::npos)
    parts[1].replace(at, 1, io::digest_of(parts[0]));
  write(shards / study::cases_file, parts[0]);
  write(shard / study::shard_file, parts[1]);
  write(shard / study::keys_file, parts[2]);
  write(shard / study::journal_file, hashed(parts[3]));
  try {
    const study::Collected all = study::collect_shards({shards});
    require(all.results.size() >= all.missing.size());
    if (all.machines.empty()) (void)support::batch_csv(all.results);
  } catch (const std::runtime_error&) {
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::string_view text(reinterpret_cast<const char*>(data) + 1, size - 1);
  switch (data[0] % 4) {
    case 0:
      read_sweep(text);
      break;
    case 1:
      read_journal(text);
      break;
    case 2:
      read_store(text);
      break;
    default:
      collect(text);
  }
  return 0;
}
