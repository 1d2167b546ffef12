#include "pages.hpp"

#include "bough/io/atomic_file.hpp"
#include "bough/report/profile_page.hpp"
#include "bough/report/split_plot.hpp"
#include "bough/report/stress_page.hpp"
#include "bough/report/study_page.hpp"

namespace bough::app {

bool can_draw(std::string_view) { return true; }

std::string write_profile_page(const std::filesystem::path& path, const results::Profile& profile,
                               const std::string& data) {
  io::write_file(path, report::profile_page(profile, data));
  return path.filename().string() + " ";
}

std::filesystem::path write_stress_page(const std::filesystem::path& path, const std::vector<study::StressCase>& cases,
                                        const study::StressOptions& options) {
  io::write_file(path, report::stress_page(cases, options));
  return path;
}

void write_split_picture(const std::filesystem::path& path, const io::SplitTable& table) {
  io::write_file(path, report::split_svg(table));
}

struct StudyPages::Entries {
  std::vector<report::StudyEntry> list;
};

StudyPages::StudyPages() : entries_(std::make_unique<Entries>()) {}
StudyPages::~StudyPages() = default;

std::filesystem::path StudyPages::write(const std::filesystem::path& path, const study::SweepResult& result) {
  io::write_file(path, report::study_html(result));
  entries_->list.push_back(report::entry_of(result));
  return path;
}

std::filesystem::path StudyPages::write_index(const std::filesystem::path& path) const {
  io::write_file(path, report::study_index_html(entries_->list));
  return path;
}

}  // namespace bough::app
