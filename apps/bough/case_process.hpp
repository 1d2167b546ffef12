#pragma once
#include "case_run.hpp"

namespace bough::app {

/// Folders of failed cases that may still be made, counted by all workers of a batch: beyond, failed cases are stored
/// as others are. Precondition of what is shared: made before workers are forked.
class FolderAllowance {
 public:
  explicit FolderAllowance(std::size_t count);
  ~FolderAllowance();
  FolderAllowance(const FolderAllowance&) = delete;
  FolderAllowance& operator=(const FolderAllowance&) = delete;
  /// False where none is left.
  bool take();

 private:
  struct Shared;
  Shared* shared_ = nullptr;  ///< in memory of all processes; none: nothing is counted, and no folder made
};

/// Runs a case in the worker that it was handed to, and tries it again where it fails and `settings` say so. Returns
/// the exit status of `bough run`. rows: takes the history of a case that is stored, row by row.
int run_case(const study::BatchCase& which, const CaseSettings& settings, const CaseSource& source,
             FolderAllowance& failed_folders, study::CaseReport& report, io::SharedText& rows);

}  // namespace bough::app
