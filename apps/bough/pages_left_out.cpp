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

std::string write_profile_page(const std::filesystem::path&, const results::Profile&, const std::string&) { return {}; }

std::filesystem::path write_stress_page(const std::filesystem::path&, const std::vector<study::StressCase>&,
                                        const study::StressOptions&) {
  return {};
}

void write_split_picture(const std::filesystem::path&, const io::SplitTable&) {}

struct StudyPages::Entries {};

StudyPages::StudyPages() = default;
StudyPages::~StudyPages() = default;
std::filesystem::path StudyPages::write(const std::filesystem::path&, const study::SweepResult&) { return {}; }
std::filesystem::path StudyPages::write_index(const std::filesystem::path&) const { return {}; }

}  // namespace bough::app
