/// Random structures that close on the ground or on themselves: clamps at several places, loops of beams, joints,
/// prescribed supports, pressure; statics and dynamics, in space and in a plane. What the plan leaves out changes no
/// result of them.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "bough/plan/plan.hpp"
#include "bough/scene/components.hpp"
#include "support/scenes.hpp"

namespace bough::run {
namespace {

using support::Outcome;
using support::text;

/// A list of JSON values.
class List {
 public:
  void add(const std::string& item) { all_ += (all_.empty() ? "" : ", ") + item; }
  std::string str() const { return "[" + all_ + "]"; }

 private:
  std::string all_;
};

class Maker {
 public:
  explicit Maker(unsigned seed)
      : random_(seed), is_dynamic_(seed % 5 >= 3), in_plane_(seed % 2 == 0), spans_(2 + pick(3)) {}

  std::string scene() {
    for (int k = 0; k <= spans_; ++k) add_node("p" + std::to_string(k), {static_cast<double>(k), shift(), side()});
    const int hinge = pick(3) == 0 ? 1 + pick(spans_ - 1) : 0;
    for (int k = 0; k < spans_; ++k) {
      std::string from = "p" + std::to_string(k);
      if (k == hinge && k > 0) {
        add_node("hinge", places_[static_cast<std::size_t>(k)]);
        joints_.add(joint("swivel", in_plane_ ? "revolute" : "spherical", from, "hinge"));
        from = "hinge";
      }
      add_beam("b" + std::to_string(k), from, "p" + std::to_string(k + 1));
    }
    const std::string last = "p" + std::to_string(spans_), middle = "p" + std::to_string(spans_ / 2);
    support("p0", "first", 0);
    support(last, "last", pick(hinge > 0 ? 3 : 4));  // between a hinge and a pin a part could spin
    if (pick(2) == 0) {                              // a strut with a clamp of its own, or a beam that closes a loop
      if (pick(2) == 0) {
        add_node("foot", {0.5 * spans_ + shift(), -1.0, side()});
        support("foot", "foot clamp", 0);
        add_beam("strut", "foot", middle);
      } else {
        add_node("apex", {0.5 * spans_ + shift(), 1.0, side()});
        add_beam("rise", middle, "apex");
        add_beam("fall", "apex", last);
      }
    }
    const double force = uniform(0.05, 0.6);
    loads_.add("{\"at\": \"" + middle + "\", \"force\": " + vector({shift() * force, -force, side() * force}) + law() +
               "}");
    if (pick(2) == 0)
      loads_.add("{\"beam\": \"b0\", \"force\": " + vector({0.0, uniform(-0.3, 0.3), in_plane_ ? 0.0 : shift()}) +
                 ", \"axes\": \"body\"" + law() + "}");
    sensors_.add("{\"name\": \"middle\", \"kind\": \"position\", \"at\": \"" + middle + "\"}");
    sensors_.add("{\"name\": \"turn\", \"kind\": \"rotation\", \"at\": \"" + middle + "\"}");
    for (const auto& [name, at] : {std::pair{"root", "0"}, std::pair{"half", "0.5"}, std::pair{"end", "1"}})
      sensors_.add("{\"name\": \"" + std::string(name) +
                   "\", \"kind\": \"section_force\", \"beam\": \"b0\", \"station\": " + at + "}");
    sensors_.add("{\"name\": \"reaction\", \"kind\": \"joint_reaction\", \"joint\": \"first\"}");
    const std::string analysis =
        is_dynamic_
            ? "{\"kind\": \"dynamic\", \"end_time\": 0.05, \"step_size\": 0.005, \"tolerance\": 1e-12}"
            : "{\"kind\": \"static\", \"tolerance\": 1e-12, \"load_steps\": " + std::to_string(1 + pick(3)) + "}";
    return "{\"sections\": [{\"name\": \"s\", \"stiffness\": {\"EA\": 2e4, \"GA2\": 8e3, \"GA3\": 8e3, \"GJ\": 1.5, "
           "\"EI2\": 2, \"EI3\": 2}, \"mass\": {\"mass_per_length\": 0.2, \"rotary\": [2e-3, 1e-3, 1e-3]}}], "
           "\"gravity\": " +
           vector({0.0, is_dynamic_ ? -2.0 : 0.0, 0.0}) + ", \"nodes\": " + nodes_.str() +
           ", \"beams\": " + beams_.str() + ", \"joints\": " + joints_.str() + ", \"motions\": " + motions_.str() +
           ", \"loads\": " + loads_.str() + ", \"sensors\": " + sensors_.str() + ", \"analysis\": " + analysis + "}";
  }

 private:
  using Place = std::array<double, 3>;
  double uniform(double a, double b) { return a + (b - a) * (static_cast<double>(random_()) / 4294967296.0); }
  int pick(int count) { return static_cast<int>(random_() % static_cast<unsigned>(count)); }
  double shift() { return uniform(-0.3, 0.3); }
  double side() { return in_plane_ ? 0.0 : shift(); }
  static std::string vector(const Place& x) { return "[" + text(x[0]) + ", " + text(x[1]) + ", " + text(x[2]) + "]"; }
  std::string law() const { return is_dynamic_ ? R"json(, "law": {"expression": "1 + sin(40*t)"})json" : ""; }
  void add_node(const std::string& name, const Place& at) {
    nodes_.add("{\"name\": \"" + name + "\", \"position\": " + vector(at) + "}");
    places_.push_back(at);
  }
  void add_beam(const std::string& name, const std::string& from, const std::string& to) {
    beams_.add("{\"name\": \"" + name + "\", \"section\": \"s\", \"start\": \"" + from + "\", \"end\": \"" + to +
               "\", \"elements\": " + std::to_string(1 + pick(3)) + ", \"order\": " + std::to_string(1 + pick(3)) +
               "}");
  }
  static std::string joint(const std::string& name, const std::string& kind, const std::string& first,
                           const std::string& second) {
    return "{\"name\": \"" + name + "\", \"kind\": \"" + kind + "\", \"first\": \"" + first + "\", \"second\": \"" +
           second + "\"" + (kind == "revolute" ? ", \"axis\": [0, 0, 1]" : "") + "}";
  }
  /// Clamped by a joint; held by a prescribed motion; moved by one; pinned.
  void support(const std::string& node, const std::string& name, int kind) {
    if (kind == 0) return joints_.add(joint(name, "fixed", "ground", node));
    if (kind == 3) return joints_.add(joint(name, in_plane_ ? "revolute" : "spherical", "ground", node));
    const std::string moved = kind == 1     ? "0"
                              : is_dynamic_ ? R"json({"expression": "0.002*(1-cos(30*t))"})json"
                                            : text(uniform(-0.01, 0.01));
    motions_.add("{\"at\": \"" + node + "\", \"x\": 0, \"y\": " + moved + ", \"z\": 0, \"rotation\": \"hold\"}");
  }

  std::mt19937 random_;
  bool is_dynamic_, in_plane_;
  int spans_;
  List nodes_, beams_, joints_, motions_, loads_, sensors_;
  std::vector<Place> places_;
};

/// Largest entry of the columns of one sensor.
double size_of_sensor(const support::Table& t, const std::string& column) {
  const std::string sensor = column.substr(0, column.rfind('.'));
  double most = 0.0;
  for (std::size_t c = 0; c < t.columns.size(); ++c)
    if (t.columns[c].substr(0, t.columns[c].rfind('.')) == sensor)
      for (const auto& row : t.rows) most = std::max(most, std::abs(row[c]));
  return most;
}

/// Positions are rounded by eps |x|, to which the stiffness EA / L of an element responds.
constexpr double floor_of_forces = 2e4 / 0.2 * 4.0 * 2.3e-16 * 30.0;

/// whole: all rows; else the last ones, of load steps that may have been cut.
void expect_equal(const Outcome& a, const Outcome& b, bool whole, const std::string& what) {
  if (whole) {
    ASSERT_EQ(a.history.rows.size(), b.history.rows.size()) << what;
  }
  for (std::size_t c = 0; c < a.history.columns.size(); ++c) {
    const std::string& column = a.history.columns[c];
    double most = 0.0;
    for (std::size_t r = 0; whole && r < a.history.rows.size(); ++r)
      most = std::max(most, std::abs(a.history.rows[r][c] - b.history.rows[r][c]));
    most = std::max(most, std::abs(a.history.rows.back()[c] - b.history.rows.back()[c]));
    EXPECT_LE(most, 1e-9 * size_of_sensor(a.history, column) + floor_of_forces) << what << ": " << column;
  }
}

class ClosedStructures : public testing::TestWithParam<int> {};

TEST_P(ClosedStructures, have_the_same_results_with_and_without_each_decision) {
  constexpr int share = 30;
  for (int k = 0; k < share; ++k) {
    const unsigned seed = static_cast<unsigned>(GetParam() * share + k);
    const std::string json = Maker(seed).scene();
    const scene::Scene scene = support::scene_of(json);
    scene::Scene bare = scene;
    bare.without = scene::decision_names();
    const Outcome plain = support::run(bare);
    ASSERT_TRUE(plain.ok()) << seed << ": " << plain.summary.cause << "\n" << json;
    const Outcome whole = support::run(scene);
    ASSERT_TRUE(whole.ok()) << seed << ": " << whole.summary.cause << "\n" << json;
    const bool is_dynamic = scene.analysis.kind == scene::AnalysisKind::dynamics;
    expect_equal(plain, whole, is_dynamic, std::to_string(seed) + " with all decisions");
    for (const plan::Decision& d : plan::make_plan(scene).decisions) {
      if (!d.taken || !d.can_be_barred) continue;
      scene::Scene s = scene;
      s.without = {d.name};
      const Outcome without = support::run(s);
      ASSERT_TRUE(without.ok()) << seed << " without " << d.name << ": " << without.summary.cause;
      expect_equal(plain, without, is_dynamic, std::to_string(seed) + " without " + d.name);
    }
    if (HasFailure()) FAIL() << json;
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, ClosedStructures, testing::Range(0, 10));

}  // namespace
}  // namespace bough::run
