#pragma once
/// The pages and pictures that verbs write beside their numbers. pages.cpp draws them; a build without BOUGH_WITH_REPORTS has
/// pages_left_out.cpp in its place, which writes nothing. The verb `view` stands there, too: it is nothing but a page.
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "bough/io/split_table.hpp"
#include "bough/results/profile.hpp"
#include "bough/study/stress.hpp"
#include "bough/study/sweep.hpp"

namespace bough::app {

/// Says on standard error that `what` needs a build with reports; returns true where this one has them.
bool can_draw(std::string_view what);

/// The page of a profile whose data lie in the file `data`; returns the names of the files written, each with a blank behind it.
std::string write_profile_page(const std::filesystem::path& path, const results::Profile& profile,
                               const std::string& data);

/// The page of the table of stiff and extreme cases; returns its path where it was written, or an empty one.
std::filesystem::path write_stress_page(const std::filesystem::path& path, const std::vector<study::StressCase>& cases,
                                        const study::StressOptions& options);

/// The split of an acceleration as SVG. Precondition: can_draw.
void write_split_picture(const std::filesystem::path& path, const io::SplitTable& table);

/// The pages of the studies of a folder and their index. Each verb returns the path where a page was written, or an empty one.
class StudyPages {
 public:
  StudyPages();
  ~StudyPages();
  StudyPages(const StudyPages&) = delete;
  StudyPages& operator=(const StudyPages&) = delete;

  std::filesystem::path write(const std::filesystem::path& path, const study::SweepResult& result);
  std::filesystem::path write_index(const std::filesystem::path& path) const;  ///< of all that were written so far

 private:
  struct Entries;
  std::unique_ptr<Entries> entries_;
};

}  // namespace bough::app
