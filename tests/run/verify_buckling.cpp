/// Critical load factors against closed forms and a boundary value problem about the bent state.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <numbers>

#include "table_seen.hpp"

namespace bough::verify {
namespace {

using support::scene_of;
using support::text;

constexpr double pi = std::numbers::pi;

struct Column {
  double EI2 = 1.0, EI3 = 1.0, GJ = 1.0, EA = 1.0, GA = 1.0;
  int elements = 16, order = 3;
};

std::string column_scene(const Column& c, const std::string& ends, const std::string& analysis) {
  return R"({"sections": [{"name": "bar", "stiffness": {"EA": )" + text(c.EA) + R"(, "GA2": )" + text(c.GA) +
         R"(, "GA3": )" + text(c.GA) + R"(, "GJ": )" + text(c.GJ) + R"(, "EI2": )" + text(c.EI2) + R"(, "EI3": )" +
         text(c.EI3) + R"(}, "mass": {"mass_per_length": 1}}],
    "nodes": [{"name": "foot"}, {"name": "top", "position": [1, 0, 0]}],
    "beams": [{"name": "column", "section": "bar", "start": "foot", "end": "top", "axis_2": [0, 1, 0], "elements": )" +
         std::to_string(c.elements) + R"(, "order": )" + std::to_string(c.order) + R"(}],)" + ends +
         R"(, "analysis": {"kind": "buckling")" + analysis + "}}";
}

/// A square section of this slenderness L / h, E = 1 in units of EI / L^2, G = E / 2.6, 5/6.
Column square(double slenderness) {
  Column c;
  const double over = 12.0 * slenderness * slenderness;  // A L^2 / I
  c.EA = over;
  c.GA = over / 2.6 * 5.0 / 6.0;
  return c;
}

const char* const push = R"("loads": [{"name": "push", "at": "top", "force": [-1, 0, 0]}])";

TEST(Buckling, columns_on_four_supports_buckle_as_eulers_with_shear_and_shortening) {
  const std::string foot = R"({"name": "clamp", "kind": "fixed", "first": "ground", "second": "foot"})";
  const std::string pinned_foot =
      R"({"name": "clamp", "kind": "universal", "first": "ground", "second": "foot", "position": [0, 0, 0], "axis": [0, 1, 0], "second_axis": [0, 0, 1]})";
  struct Case {
    const char* name;
    std::string joints, motions;
    double inextensible;
  };
  const Case cases[] = {
      {"clamped-free", foot, "", pi * pi / 4.0},
      {"pinned-pinned", pinned_foot, R"(, "motions": [{"name": "guide", "at": "top", "y": 0, "z": 0}])", pi * pi},
      {"clamped-clamped", foot, R"(, "motions": [{"name": "guide", "at": "top", "y": 0, "z": 0, "rotation": "hold"}])",
       4.0 * pi * pi},
      {"clamped-pinned", foot, R"(, "motions": [{"name": "guide", "at": "top", "y": 0, "z": 0}])", 20.190728556426629},
  };
  const double exact[4][2] = {{2.46471804812228, 2.467293553776851},
                              {9.826953089652771, 9.867884107006787},
                              {38.81306701221237, 39.45092164216541},
                              {19.98818575442866, 20.18248269503006}};
  for (std::size_t k = 0; k < 4; ++k)
    for (std::size_t j = 0; j < 2; ++j) {
      const double slenderness = j == 0 ? 20.0 : 100.0;
      const support::Outcome outcome = support::run_ok(scene_of(column_scene(
          square(slenderness), std::string(push) + R"(, "joints": [)" + cases[k].joints + "]" + cases[k].motions, "")));
      const TableSeen seen(outcome, "buckling");
      ASSERT_GE(seen.count(), 1U) << cases[k].name;
      const double found = seen.number(0, "load_factor");
      std::printf("| %s, L/h %g | %.12f, %.1e off |\n", cases[k].name, slenderness, found, found / exact[k][j] - 1.0);
      EXPECT_NEAR(found, exact[k][j], 2e-8 * exact[k][j]) << cases[k].name;
      EXPECT_EQ(seen.count(), 2U) << cases[k].name;  // in both planes
    }
}

/// EI_stiff / EI_weak of 1e4 to 4: about the bent state the load is other than Prandtl's.
TEST(Buckling, a_cantilever_bent_in_its_stiff_plane_buckles_sideways_as_computed_about_the_bent_state) {
  const struct {
    double stiff, EA, load;
    int elements;
  } cases[] = {{1e4, 1e8, 3.589341925, 12},
               {100.0, 1e7, 3.626206912, 12},
               {10.0, 1e6, 4.057925860, 24},
               {4.0, 1e6, 5.630638387, 24}};
  for (const auto& one : cases) {
    Column c;
    c.EI2 = one.stiff;
    c.EI3 = 1.0;
    c.GJ = 0.8;
    c.EA = c.GA = one.EA;
    c.elements = one.elements;
    const support::Outcome outcome =
        support::run_ok(scene_of(column_scene(c, R"("loads": [{"name": "weight", "at": "top", "force": [0, 0, -1]}],
              "joints": [{"name": "clamp", "kind": "fixed", "first": "ground", "second": "foot"}])",
                                              "")));
    const TableSeen seen(outcome, "buckling");
    ASSERT_GE(seen.count(), 1U);
    const double found = seen.number(0, "load_factor");
    std::printf("| lateral buckling, EI ratio %g | %.9f, %.1e off, last change %.1e |\n", one.stiff, found,
                found / one.load - 1.0, seen.number(0, "last_change"));
    // The weakest stiffness is known to the round-off of the largest entry, which is of the order of 10 EA n / L.
    EXPECT_NEAR(found, one.load, 1e-8 * one.load + 3e-16 * 10.0 * one.EA * c.elements);
  }
}

/// A quarter of a ring under the pressure of a fluid, which stays normal to it: 3 EI / R^3.
TEST(Buckling, a_ring_under_the_pressure_of_a_fluid_gives_way_as_its_closed_form) {
  const support::Outcome outcome = support::run_ok(scene_of(R"({
    "sections": [{"name": "bar", "stiffness": {"EA": 1e7, "GA2": 1e7, "GA3": 1e7, "GJ": 1e3, "EI2": 1e3, "EI3": 1}, "mass": {"mass_per_length": 1}}],
    "nodes": [{"name": "right", "position": [1, 0, 0]}, {"name": "top", "position": [0, 1, 0]}],
    "beams": [{"name": "ring", "section": "bar", "start": "right", "end": "top", "axis_2": [-1, 0, 0], "elements": 12, "order": 3,
               "curve": {"curvature": [0, 0, 1], "length": )" +
                                                            text(0.5 * pi) + R"(, "tangent": [0, 1, 0]}}],
    "motions": [{"name": "a", "at": "right", "y": 0, "z": 0, "rotation": "hold"}, {"name": "b", "at": "top", "x": 0, "z": 0, "rotation": "hold"}],
    "loads": [{"name": "pressure", "beam": "ring", "axes": "body", "force": [0, 1, 0]}],
    "analysis": {"kind": "buckling"}})"));
  const double found = TableSeen(outcome, "buckling").number(0, "load_factor");
  std::printf("| ring under fluid pressure | %.9f |\n", found);
  EXPECT_NEAR(found, 3.0, 2e-6);  // EI / (EA R^2) is 1e-7
}

TEST(Buckling, factors_scale_with_the_load_that_is_given) {
  double first = 0.0;
  for (const double size : {1.0, 1e-6, 1e4}) {
    const support::Outcome outcome = support::run_ok(scene_of(
        column_scene(square(50.0), R"("loads": [{"name": "push", "at": "top", "force": [)" + text(-size) + R"(, 0, 0]}],
          "joints": [{"name": "clamp", "kind": "fixed", "first": "ground", "second": "foot"}])",
                     "")));
    const double found = TableSeen(outcome, "buckling").number(0, "load_factor") * size;
    if (first == 0.0) first = found;
    EXPECT_NEAR(found, first, 1e-9 * first);
  }
}

TEST(Buckling, several_factors_are_those_of_the_closed_form_and_a_bound_is_kept) {
  const Column c = square(100.0);
  const std::string ends =
      std::string(push) + R"(, "joints": [{"name": "clamp", "kind": "fixed", "first": "ground", "second": "foot"}])";
  const support::Outcome outcome = support::run_ok(scene_of(column_scene(c, ends, R"(, "count": 4)")));
  const TableSeen seen(outcome, "buckling");
  ASSERT_EQ(seen.count(), 4U);
  for (std::size_t k = 0; k < 4; ++k) {
    // P (1 + P (1/GA - 1/EA)) = n pi^2 EI / L^2
    const double euler = (k < 2 ? 1.0 : 9.0) * pi * pi / 4.0, soft = 1.0 / c.GA - 1.0 / c.EA;
    const double exact = (std::sqrt(1.0 + 4.0 * soft * euler) - 1.0) / (2.0 * soft);
    EXPECT_NEAR(seen.number(k, "load_factor"), exact, 2e-8 * exact) << k;
  }
  const support::Outcome bounded = support::run_ok(scene_of(column_scene(c, ends, R"(, "largest_factor": 2)")));
  EXPECT_EQ(TableSeen(bounded, "buckling").count(), 0U);
  EXPECT_TRUE(says_one_of(bounded.summary.notes, "no critical load factor up to 2"));
}

TEST(Buckling, what_is_pulled_does_not_buckle) {
  const support::Outcome outcome = support::run_ok(
      scene_of(column_scene(square(50.0), R"("loads": [{"name": "pull", "at": "top", "force": [1, 0, 0]}],
        "joints": [{"name": "clamp", "kind": "fixed", "first": "ground", "second": "foot"}])",
                            "")));
  EXPECT_EQ(TableSeen(outcome, "buckling").count(), 0U);
}

TEST(Buckling, a_load_without_a_potential_is_told_not_to_be_examined_for_flutter) {
  // Beck's column flutters at 20.05 and has no divergence.
  const support::Outcome outcome = support::run_ok(scene_of(
      column_scene(square(100.0), R"("loads": [{"name": "push", "at": "top", "axes": "body", "force": [-1, 0, 0]}],
        "joints": [{"name": "clamp", "kind": "fixed", "first": "ground", "second": "foot"}])",
                   R"(, "largest_factor": 40)")));
  EXPECT_EQ(TableSeen(outcome, "buckling").count(), 0U);
  EXPECT_NE(outcome.summary.not_judged.find("flutter"), std::string::npos);
}

}  // namespace
}  // namespace bough::verify
