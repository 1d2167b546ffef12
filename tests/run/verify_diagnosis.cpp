/// A scene that can not be computed ends with a cause that names what is wrong with it, and one that can ends without
/// a false alarm.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "bough/io/read_scene.hpp"
#include "verify_diagnosis_cases.hpp"
#include "verify_scenes.hpp"

namespace bough::verify {
namespace {

struct Verdict {
  Fate fate = Fate::fails;
  std::string said;
};

Verdict judge(const Diagnosis& c) {
  const io::SceneFile file = io::read_scene_text("{\"schema_version\": 1, " + c.text + "}", "case");
  if (!file.ok()) {
    Verdict v{Fate::refused, ""};
    for (const io::Problem& p : file.problems) v.said += p.text() + "\n";
    return v;
  }
  scene::Scene spatial = file.scene;
  spatial.without = {"welded", "line", "translation", "planar"};  // where what is wrong can show
  const Outcome o = run(spatial);
  for (const records::HistoryRow& row : o.rows)
    for (double x : row.values) EXPECT_TRUE(std::isfinite(x)) << c.name << ": a number that is not finite was recorded";
  return {o.ok() ? Fate::runs : Fate::fails, o.text()};
}

void check(const std::vector<Diagnosis>& cases) {
  static const char* const fates[] = {"runs", "fails", "is refused"};
  for (const Diagnosis& c : cases) {
    const Verdict v = judge(c);
    std::printf("  %s: %s\n    %s\n", c.name.c_str(), fates[static_cast<int>(v.fate)], v.said.c_str());
    EXPECT_EQ(static_cast<int>(v.fate), static_cast<int>(c.fate))
        << c.name << " " << fates[static_cast<int>(v.fate)] << "\n"
        << v.said;
    for (const std::string& word : c.words)
      EXPECT_NE(v.said.find(word), std::string::npos) << c.name << " does not say " << word << ":\n" << v.said;
  }
}

TEST(VerifyDiagnosis, too_many_constraints) { check(over_constrained_cases()); }
TEST(VerifyDiagnosis, too_few_constraints_or_too_little_inertia) { check(under_constrained_cases()); }
TEST(VerifyDiagnosis, jumps_branches_and_numbers_that_are_not_finite) { check(hard_cases()); }

/// The gallery runs, and only scenes that are redundant say so.
TEST(VerifyDiagnosis, no_false_alarm_on_the_gallery) {
  for (const std::string& name : gallery_names()) {
    scene::Scene s = gallery(name);
    s.expected.clear();
    if (s.analysis.kind == scene::AnalysisKind::dynamics)
      s.analysis.end_time = std::min(s.analysis.end_time, 100.0 * s.analysis.step_size);
    s.without = {"planar"};  // a plane has no redundant rows
    const Outcome o = run(s);
    EXPECT_TRUE(o.ok()) << name << ": " << o.text();
    const bool redundant = name == "bricard" || name == "andrews_squeezer" || name == "four_bar_planar" ||
                           name == "four_bar_windows" || name == "hanging_chain";
    EXPECT_EQ(o.says("depend on others"), redundant) << name << ": " << o.text();
    EXPECT_LT(o.summary.checks.linear_backward_error_max, 1e-10) << name;
    std::printf("  %s: backward error %.1e\n    %s\n", name.c_str(), o.summary.checks.linear_backward_error_max,
                o.text().c_str());
  }
}

}  // namespace
}  // namespace bough::verify
