/// bough status DIR: how far a run or a batch has come, while it goes on or after it has stopped.
#include <iostream>
#include <unordered_set>

#include "arguments.hpp"
#include "bough/io/csv_table.hpp"
#include "bough/io/folder_lock.hpp"
#include "bough/io/input_file.hpp"
#include "bough/io/number_text.hpp"
#include "bough/io/quantity_text.hpp"
#include "bough/io/summary.hpp"
#include "bough/io/unfinished_run.hpp"
#include "bough/study/collect.hpp"
#include "bough/study/journal.hpp"
#include "terminal.hpp"

namespace bough::app {
namespace {

std::string text_of(const io::UnfinishedRun& run) {
  std::string text = run.goes_on ? "runs" : "was cut off before its end";
  if (run.progress) {
    const io::RunProgress& p = *run.progress;
    text += ": time " + io::rounded_text(p.time, 6) + " of " + io::rounded_text(p.end_time, 6) + ", " +
            std::to_string(p.steps) + (p.steps == 1 ? " step, " : " steps, ") + io::seconds_text(p.seconds) +
            (p.from > 0.0 ? " since it went on" : "");
    if (run.goes_on && p.seconds_left() > 0.0) text += ", about " + io::seconds_text(p.seconds_left()) + " left";
  }
  if (run.checkpoint)
    text += "; the last checkpoint is of time " + io::rounded_text(*run.checkpoint, 6) +
            (run.goes_on ? "" : ", from which --resume goes on");
  return text;
}

/// Cases that are done, by the journals of a batch, of as many as keys.csv lists.
std::string text_of_batch(const std::filesystem::path& folder) {
  io::CsvTable keys;
  if (const std::string fault = keys.read(io::read_text(folder / study::keys_file)); !fault.empty())
    throw std::runtime_error((folder / study::keys_file).string() + ": " + fault);
  std::unordered_set<std::string> listed, done;
  for (const std::vector<std::string>& row : keys.rows)
    if (row.size() == 2) listed.insert(row[1]);
  std::size_t good = 0;
  study::for_each_record(folder / study::journal_file,
                         [&](const std::string& key, const study::CaseResult& result, std::string_view) {
                           if (!study::is_final(result) || !listed.contains(key) || !done.insert(key).second) return;
                           good += result.status == study::CaseStatus::ok ? 1 : 0;
                         });
  const bool goes_on = !io::FolderLock().take(folder);
  return std::string(goes_on                        ? "runs"
                     : done.size() == listed.size() ? "is done"
                                                    : "was stopped") +
         ": " + std::to_string(done.size()) + " of " + std::to_string(listed.size()) + " cases are done, " +
         std::to_string(done.size() - good) + " of these not ok" +
         (goes_on || done.size() == listed.size() ? "" : "; --resume goes on");
}

}  // namespace

int status(const StatusArguments& arguments) {
  const std::filesystem::path& folder = arguments.directory;
  std::error_code ignored;
  try {
    if (std::filesystem::exists(folder / study::keys_file, ignored)) {
      std::cout << folder.string() << " " << text_of_batch(folder) << "\n";
    } else if (const std::optional<io::UnfinishedRun> run = io::find_unfinished_run(folder)) {
      std::cout << folder.string() << " " << text_of(*run) << "\n";
    } else {
      const io::SummaryFile summary = io::read_whole_summary(folder, {});
      std::cout << folder.string() << " has ended: " << summary.status
                << (summary.cause.empty() ? "" : ", " + summary.cause) << ", " << summary.accepted << " steps\n";
    }
  } catch (const std::exception& error) {
    std::cerr << "bough: " << error.what() << "\n";
    return exit_bad_input;
  }
  return exit_done;
}

}  // namespace bough::app
