#include "pages.hpp"

#include "bough/io/atomic_file.hpp"
#include "bough/report/batch_page.hpp"
#include "bough/report/profile_page.hpp"
#include "bough/report/split_plot.hpp"
#include "bough/report/stress_page.hpp"
#include "bough/report/study_page.hpp"

namespace bough::app {

bool can_draw(std::string_view) { return true; }

std::string write_profile_page(io::OutputFolder& folder, const std::string& name, const records::Profile& profile,
                               const std::string& data) {
  folder.write(name, report::profile_page(profile, data));
  return name + " ";
}

std::string write_stress_page(io::OutputFolder& folder, const std::string& name,
                              const std::vector<stress::StressCase>& cases, const stress::StressOptions& options) {
  folder.write(name, report::stress_page(cases, options));
  return name;
}

void write_batch_page(io::OutputCollection& folder, const study::CaseTable& results, const std::string& title,
                      const std::vector<study::MeasureSensitivity>& sensitivities, bool goes_on) {
  folder.write("batch.html", report::batch_page(results, title, sensitivities, goes_on));
}

void write_split_picture(const std::filesystem::path& path, const io::SplitTable& table) {
  io::write_file(path, report::split_svg(table));
}

struct StudyPages::Entries {
  std::vector<report::StudyEntry> list;
};

StudyPages::StudyPages() : entries_(std::make_unique<Entries>()) {}
StudyPages::~StudyPages() = default;

std::string StudyPages::write(io::OutputFolder& folder, const std::string& name, const study::SweepResult& result) {
  folder.write(name, report::study_html(result));
  entries_->list.push_back(report::entry_of(result));
  return name;
}

std::string StudyPages::write_index(io::OutputCollection& folder, const std::string& name) const {
  folder.write(name, report::study_index_html(entries_->list));
  return name;
}

}  // namespace bough::app
