// The tables of kinds of joints and of sensors, and what texts say of them.
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "bough/motion/se3.hpp"
#include "bough/scene/analysis_kinds.hpp"
#include "bough/scene/sensor_kinds.hpp"
#include "bough/scene/signals.hpp"
#include "support/source_dir.hpp"

namespace bough::scene {
namespace {

std::string guide(const std::string& name) {
  std::ifstream file(support::source_dir() / "data/manual/guides" / name);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

std::string escaped(std::string text) {
  for (std::size_t at = text.find('|'); at != std::string::npos; at = text.find('|', at + 2)) text.insert(at, "\\");
  return text;
}

TEST(Kinds, the_manual_has_the_row_of_every_joint) {
  const std::string text = guide("joints.md");
  for (const JointType& type : joint_types()) {
    std::string coordinates;
    for (const JointCoordinate& c : type.coordinates) coordinates += (coordinates.empty() ? "" : ", ") + c.name;
    const std::string row = "| `" + type.name + "` | " + escaped(equations_of(type)) + " | " +
                            (coordinates.empty() ? "none" : coordinates) + " | " + type.about + " |\n";
    EXPECT_NE(text.find(row), std::string::npos) << "data/manual/guides/joints.md needs\n" << row;
  }
}

TEST(Kinds, the_manual_has_the_row_of_every_sensor) {
  const std::string text = guide("measures.md");
  for (const SensorType& type : sensor_types()) {
    const std::string row = "| `" + type.name + "` | " + components_text(type) + " | " + type.about + " |\n";
    EXPECT_NE(text.find(row), std::string::npos) << "data/manual/guides/measures.md needs\n" << row;
  }
}

TEST(Kinds, the_manual_has_the_row_of_every_signal) {
  const std::string text = guide("signals.md");
  for (const SignalType& type : signal_types()) {
    const std::string row =
        "| `" + std::string(type.name) + "` | " + std::string(type.unit) + " | " + std::string(type.about) + " |\n";
    EXPECT_NE(text.find(row), std::string::npos) << "data/manual/guides/signals.md needs\n" << row;
  }
}

TEST(Kinds, entries_stand_in_the_order_of_their_enumeration_under_names_of_their_own) {
  for (const JointType& type : joint_types()) {
    EXPECT_EQ(&type_of(type.kind), &type) << type.name;
    EXPECT_EQ(joint_kind_named(type.name), type.kind);
    EXPECT_LE(type.rows.size(), 6U);
  }
  for (const SensorType& type : sensor_types()) {
    EXPECT_EQ(&type_of(type.kind), &type) << type.name;
    EXPECT_EQ(sensor_kind_named(type.name), type.kind);
    EXPECT_FALSE(type.components.empty()) << type.name;
  }
  for (const AnalysisType& type : analysis_types()) {
    EXPECT_EQ(&type_of(type.kind), &type) << type.name;
    EXPECT_EQ(analysis_kind_named(type.name), type.kind);
  }
  for (const SignalType& type : signal_types()) {
    EXPECT_EQ(type_of(type.kind).kind, type.kind) << type.name;
    EXPECT_EQ(signal_kind_named(type.name), type.kind);
  }
}

TEST(Kinds, every_row_has_the_gradient_of_its_value) {
  // Central differences of a pose off all constraints.
  const Frame H{motion::exp_so3(Vec3{{0.3, -0.4, 0.7}}), Vec3{{0.5, -0.2, 0.9}}};
  constexpr double step = 1e-6, pitch = 0.4;
  for (const JointType& type : joint_types())
    for (const JointRow& row : type.rows)
      for (int k = 0; k < 6; ++k) {
        Vec6 change = Vec6::zero();
        change[k] = step;
        const double up = eval_row(row, pitch, motion::compose(H, motion::exp_se3(change))).value;
        change[k] = -step;
        const double down = eval_row(row, pitch, motion::compose(H, motion::exp_se3(change))).value;
        EXPECT_NEAR(eval_row(row, pitch, H).gradient[k], (up - down) / (2.0 * step), 1e-9) << type.name;
      }
}

}  // namespace
}  // namespace bough::scene
