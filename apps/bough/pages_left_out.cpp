/// What stands in the place of pages.cpp and cmd_view.cpp in a build without reports.
#include <iostream>

#include "arguments.hpp"
#include "pages.hpp"

namespace bough::app {

bool can_draw(std::string_view what) {
  std::cerr << "bough: " << what << " needs a program that was built with reports (cmake -DBOUGH_WITH_REPORTS=ON)\n";
  return false;
}

int view(const ViewArguments&) {
  can_draw("the verb view");
  return exit_bad_input;
}

std::string write_profile_page(io::OutputFolder&, const std::string&, const records::Profile&, const std::string&) {
  return {};
}

std::string write_stress_page(io::OutputFolder&, const std::string&, const std::vector<stress::StressCase>&,
                              const stress::StressOptions&) {
  return {};
}

void write_batch_page(io::OutputCollection&, const study::CaseTable&, const std::string&,
                      const std::vector<study::MeasureSensitivity>&, bool) {}

void write_split_picture(const std::filesystem::path&, const io::SplitTable&) {}

struct StudyPages::Entries {};

StudyPages::StudyPages() = default;
StudyPages::~StudyPages() = default;
std::string StudyPages::write(io::OutputFolder&, const std::string&, const study::SweepResult&) { return {}; }
std::string StudyPages::write_index(io::OutputCollection&, const std::string&) const { return {}; }

}  // namespace bough::app
