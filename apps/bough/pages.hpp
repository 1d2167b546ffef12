#pragma once
/// The pages and pictures that verbs write beside their numbers. pages.cpp draws them; a build without
/// BOUGH_WITH_REPORTS has pages_left_out.cpp in its place, which writes nothing. The verb `view` stands there, too:
/// it is nothing but a page.
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "bough/io/output_folder.hpp"
#include "bough/io/split_table.hpp"
#include "bough/records/profile.hpp"
#include "bough/stress/stress.hpp"
#include "bough/study/batch.hpp"
#include "bough/study/sweep.hpp"

namespace bough::app {

/// Says on standard error that `what` needs a build with reports; returns true where this one has them.
bool can_draw(std::string_view what);

/// The page of a profile whose data lie in the file `data`; returns the names of the files written, each with a blank
/// behind it.
std::string write_profile_page(io::OutputFolder& folder, const std::string& name, const records::Profile& profile,
                               const std::string& data);

/// The page of the table of stiff and extreme cases; returns its name where it was written, or an empty one.
std::string write_stress_page(io::OutputFolder& folder, const std::string& name,
                              const std::vector<stress::StressCase>& cases, const stress::StressOptions& options);

/// The page of a batch or sweep, which may go on; does nothing without reports.
void write_batch_page(io::OutputCollection& folder, const study::CaseTable& results, const std::string& title,
                      const std::vector<study::MeasureSensitivity>& sensitivities, bool goes_on);

/// The split of an acceleration as SVG. Precondition: can_draw.
void write_split_picture(const std::filesystem::path& path, const io::SplitTable& table);

/// The pages of the studies of a folder and their index. Each verb returns the name of the page that was written, or
/// an empty one.
class StudyPages {
 public:
  StudyPages();
  ~StudyPages();
  StudyPages(const StudyPages&) = delete;
  StudyPages& operator=(const StudyPages&) = delete;

  std::string write(io::OutputFolder& folder, const std::string& name, const study::SweepResult& result);
  std::string write_index(io::OutputCollection& folder,
                          const std::string& name) const;  ///< of all written so far

 private:
  struct Entries;
  std::unique_ptr<Entries> entries_;
};

}  // namespace bough::app
