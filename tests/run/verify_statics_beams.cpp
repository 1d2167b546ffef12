/// Beams in statics against closed forms and boundary value problems solved to 12 digits or better: 1e-6 of the
/// largest value, and the order at which elements of one, two and three intervals converge: 2, 4, 6. A jib of them
/// against a truss computed by hand.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <fstream>
#include <functional>
#include <numbers>
#include <sstream>

#include "support/source_dir.hpp"
#include "verify_scenes.hpp"

namespace bough::verify {
namespace {

using std::numbers::pi;

double distance(const Vec3<double>& a, const Vec3<double>& b) {
  const Vec3<double> d = a - b;
  return std::sqrt(lanes::dot(d, d));
}

Vec3<double> final_point(const Outcome& o, const std::string& name) {
  return {{o.final(name + ".x"), o.final(name + ".y"), o.final(name + ".z")}};
}

/// Runs a scene of `elements` elements of an order and gives a point.
using Model = std::function<Vec3<double>(int elements, int order)>;

struct Convergence {
  double order = 0.0;         ///< from the differences of three meshes
  double extrapolated = 0.0;  ///< error of the Richardson value with the order of theory [m]
  double finest = 0.0;        ///< error of the finest mesh [m]
};

/// Meshes of n, 2n, 4n elements. Two differences show the order without the reference, which has no part in it.
Convergence study(const Model& model, int n, int order, const Vec3<double>& exact) {
  const Vec3<double> a = model(n, order), b = model(2 * n, order), c = model(4 * n, order);
  Convergence r;
  r.order = observed_order(distance(a, b), distance(b, c));
  const double factor = std::pow(2.0, 2.0 * order);
  r.extrapolated = distance(c + (1.0 / (factor - 1.0)) * (c - b), exact);
  r.finest = distance(c, exact);
  return r;
}

void expect_converges(const Model& model, std::array<int, 3> meshes, const Vec3<double>& exact, double scale) {
  for (int order = 1; order <= 3; ++order) {
    const Convergence r = study(model, meshes[static_cast<std::size_t>(order - 1)], order, exact);
    ::testing::Test::RecordProperty("order_" + std::to_string(order), std::to_string(r.order));
    std::printf("  order %d: observed %.3f, finest %.2e, extrapolated %.2e of the largest value\n", order, r.order,
                r.finest / scale, r.extrapolated / scale);
    EXPECT_NEAR(r.order, 2.0 * order, 0.2) << "elements of order " << order;
    EXPECT_LT(std::min(r.finest, r.extrapolated), 1e-6 * scale) << "elements of order " << order;
  }
}

TEST(VerifyStatics, roll_up_is_exact_for_any_mesh) {
  const double L = 10.0, EI = 100.0;
  for (const double f : {0.25, 0.5, 1.0, 2.0})
    for (int order = 1; order <= 3; ++order) {
      scene::Scene s = scene::make_cantilever(scene::make_section("s", 1e4, 5e3, 5e3, EI, EI, EI), L, 10, order);
      s.point_loads = {scene::make_load("tip", Vec3<double>::zero(), {{0, 0, f * 2.0 * pi * EI / L}})};
      s.analysis.load_steps = 4;
      const Outcome o = run(s);
      ASSERT_TRUE(o.ok()) << o.text();
      const double a = 2.0 * pi * f;
      EXPECT_LT(distance(final_point(o, "tip"), {{L * std::sin(a) / a, L * (1.0 - std::cos(a)) / a, 0.0}}), 1e-9 * L)
          << f << " " << order;
    }
}

TEST(VerifyStatics, constant_moment_winds_a_helix_whether_fixed_in_space_or_to_the_tip) {
  for (const scene::LoadAxes axes : {scene::LoadAxes::space, scene::LoadAxes::body})
    for (int order = 1; order <= 3; ++order) {
      scene::Scene s = scene::make_cantilever(scene::make_section("s", 1e4, 5e3, 5e3, 100, 100, 100), 10.0, 10, order);
      s.point_loads = {scene::make_load("tip", Vec3<double>::zero(), {{30, 0, 40}}, axes)};
      s.analysis.load_steps = 10;
      const Outcome o = run(s);
      ASSERT_TRUE(o.ok()) << o.text();
      EXPECT_LT(distance(final_point(o, "tip"), {{2.3725769284311828, 1.146140503258838, 5.7205673036766129}}),
                1e-9 * 10)
          << order;
    }
}

Vec3<double> elastica(double load, double axial, int elements, int order) {
  scene::Scene s = scene::make_cantilever(scene::make_section("s", axial, axial, axial, 1, 1, 1), 1.0, elements, order);
  s.point_loads = {scene::make_load("tip", {{0, load, 0}})};
  s.analysis.load_steps = 5;
  s.analysis.tolerance = 1e-11;
  const Outcome o = run(s);
  EXPECT_TRUE(o.ok()) << o.text();
  return o.ok() ? final_point(o, "tip") : Vec3<double>::zero();
}

/// The reference is the limit without shear and extension; both add a part proportional to EI/(EA L^2), taken out by
/// two stiffnesses.
TEST(VerifyStatics, elastica_at_loads_1_5_10) {
  struct Row {
    double load, v, u;
  };
  for (const Row r :
       {Row{1, .30172077379981353, .0564332362833768831}, Row{5, .713791523611912728, .387628360724429872},
        Row{10, .810609024880296453, .55499559775375127}}) {
    const Vec3<double> exact{{1.0 - r.u, r.v, 0.0}};
    const Vec3<double> soft = elastica(r.load, 1e5, 16, 3), stiff = elastica(r.load, 1e6, 16, 3);
    const Vec3<double> limit = stiff + (1.0 / 9.0) * (stiff - soft);
    EXPECT_NEAR(distance(soft, exact) / distance(stiff, exact), 10.0, 0.2) << r.load;
    EXPECT_LT(distance(limit, exact), 1e-8) << r.load;
    std::printf("  load %g: EA L^2/EI = 1e6 %.2e, limit %.2e\n", r.load, distance(stiff, exact),
                distance(limit, exact));
  }
}

TEST(VerifyStatics, elastica_converges_with_orders_2_4_6) {
  const double axial = 1e6;
  const Vec3<double> exact = elastica(10.0, axial, 64, 3);
  expect_converges([&](int n, int order) { return elastica(10.0, axial, n, order); }, {16, 8, 8}, exact, 1.0);
}

Vec3<double> shear_cantilever(int elements, int order, double* slope = nullptr) {
  const double h = 0.5, w = 0.1, E = 2.07e11, nu = 0.3, k = 10.0 * (1.0 + nu) / (12.0 + 11.0 * nu),
               G = E / (2.0 * (1.0 + nu));
  const double A = h * w, I = w * h * h * h / 12.0;
  scene::Scene s = scene::make_cantilever(scene::make_section("s", E * A, k * G * A, k * G * A, G * I, E * I, E * I),
                                          2.0, elements, order);
  s.point_loads = {scene::make_load("tip", {{0, 5e8 * h * h * h, 0}})};
  s.analysis.load_steps = 4;
  s.analysis.tolerance = 1e-11;
  const Outcome o = run(s);
  EXPECT_TRUE(o.ok()) << o.text();
  if (!o.ok()) return Vec3<double>::zero();
  if (slope != nullptr) *slope = o.final("turn.rz");
  return final_point(o, "tip");
}

TEST(VerifyStatics, shear_deformable_cantilever) {
  const Vec3<double> exact{{2.0 - 0.150971144239292, 0.710568597853648, 0.0}};
  expect_converges([](int n, int order) { return shear_cantilever(n, order); }, {16, 4, 4}, exact, 0.71);
  double slope = 0.0;
  EXPECT_LT(distance(shear_cantilever(16, 3, &slope), exact), 1e-9);
  EXPECT_NEAR(slope, 0.520173166012, 2e-12 + 1e-10);
}

Vec3<double> bend(double load, int elements, int order) {
  scene::Scene s =
      gallery("bend_45", {"/beams/0/elements=" + std::to_string(elements), "/beams/0/order=" + std::to_string(order),
                          "/loads/0/force=[0,0," + std::to_string(load) + "]", "/analysis/tolerance=1e-11"});
  s.expected.clear();
  const Outcome o = run(s);
  EXPECT_TRUE(o.ok()) << o.text();
  return o.ok() ? final_point(o, "tip") : Vec3<double>::zero();
}

TEST(VerifyStatics, bend_of_45_degrees_under_300_and_600) {
  const Vec3<double> start{{100.0 * std::sin(pi / 4), 100.0 * (1.0 - std::cos(pi / 4)), 0.0}};
  const Vec3<double> u300{{-11.931780788680, -7.044642454669, 40.192392332295}},
      u600{{-23.560581878313, -13.604632402366, 53.475477998225}};
  expect_converges([](int n, int order) { return bend(300.0, n, order); }, {16, 4, 4}, start + u300, 40.0);
  expect_converges([](int n, int order) { return bend(600.0, n, order); }, {16, 4, 4}, start + u600, 53.0);
}

struct PrincetonRow {
  double load, degrees, u[3], twist, turn[3], moment[3];
};

std::vector<PrincetonRow> read_princeton() {
  std::ifstream file(support::source_dir() / "data" / "reference" / "princeton_P1_P2.csv");
  std::string line;
  std::getline(file, line);
  std::vector<PrincetonRow> rows;
  while (std::getline(file, line)) {
    for (char& c : line)
      if (c == ',') c = ' ';
    std::istringstream in(line);
    PrincetonRow r{};
    in >> r.load >> r.degrees;
    for (double& v : r.u) in >> v;
    in >> r.twist;
    for (double& v : r.turn) in >> v;
    for (double& v : r.moment) in >> v;
    if (in) rows.push_back(r);
  }
  return rows;
}

TEST(VerifyStatics, princeton_beam_every_five_degrees_at_both_loads) {
  const std::vector<PrincetonRow> rows = read_princeton();
  ASSERT_EQ(rows.size(), 38u);
  double worst[4] = {0, 0, 0, 0}, largest[4] = {0, 0, 0, 0};
  for (const PrincetonRow& r : rows) {
    scene::Scene s = gallery("princeton_beam", {"/analysis/tolerance=1e-11"});
    s.expected.clear();
    s.sensors.push_back(scene::make_section_sensor("root", "beam", 0.0));
    const double a = r.degrees * pi / 180.0;
    s.point_loads[0].force = {{0, r.load * std::sin(a), r.load * std::cos(a)}};
    const Outcome o = run(s);
    ASSERT_TRUE(o.ok()) << o.text();
    const Vec3<double> tip = final_point(o, "tip");
    const double* turn[3];
    const double rx = o.final("tip rotation.rx"), ry = o.final("tip rotation.ry"), rz = o.final("tip rotation.rz");
    turn[0] = &rx, turn[1] = &ry, turn[2] = &rz;
    const motion::Mat3<double> R = motion::exp_so3(Vec3<double>{{rx, ry, rz}});
    const double u[3] = {tip[0] - 0.508, tip[1], tip[2]};
    for (int i = 0; i < 3; ++i) {
      worst[0] = std::max(worst[0], std::abs(u[i] - r.u[i]));
      largest[0] = std::max(largest[0], std::abs(r.u[i]));
      worst[2] = std::max(worst[2], std::abs(*turn[i] - r.turn[i]));
      largest[2] = std::max(largest[2], std::abs(r.turn[i]));
    }
    worst[1] = std::max(worst[1], std::abs(std::atan2(-R(1, 2), R(2, 2)) - r.twist));
    largest[1] = std::max(largest[1], std::abs(r.twist));
    const double m[3] = {o.final("root.T"), o.final("root.M2"), o.final("root.M3")};
    for (int i = 0; i < 3; ++i) {
      worst[3] = std::max(worst[3], std::abs(m[i] - r.moment[i]));
      largest[3] = std::max(largest[3], std::abs(r.moment[i]));
    }
  }
  std::printf("  displacement %.2e, twist %.2e, rotation %.2e, root moment %.2e of the largest value\n",
              worst[0] / largest[0], worst[1] / largest[1], worst[2] / largest[2], worst[3] / largest[3]);
  for (int q = 0; q < 4; ++q) EXPECT_LT(worst[q], 1e-6 * largest[q]) << q;
}

/// Of the jib in the gallery, under the load at rest: chords bend it, braces shear it,
///   I = h^2 A_t A_b / (A_t + A_b),   w = P L^3 / (3 E I) + n 4 N^2 l / (P E A_brace),   N = P l / (2 h),
/// n bays with four braces of length l; the chord at the tower carries P (L - x) / h. Stiff connections and the ends
/// of the top chord make 1 % of it.
TEST(VerifyStatics, a_jib_sinks_as_its_chords_and_braces_say) {
  scene::Scene s = gallery("tower_crane_jib");
  s.expected.clear();
  s.analysis.kind = scene::AnalysisKind::statics;
  s.analysis.load_steps = 2;
  const Outcome o = run(s);
  ASSERT_TRUE(o.ok()) << o.text();
  const auto tube = [](double outer, double inner) { return pi * (outer * outer - inner * inner); };
  const double E = 2.1e11, P = 1e4, L = 18.0, h = 1.0, l = std::sqrt(0.75 * 0.75 + 0.6 * 0.6 + h * h), n = 12.0;
  const double top = tube(0.04445, 0.03645), bottom = 2.0 * tube(0.03805, 0.03175), brace = tube(0.0212, 0.018);
  const double I = h * h * top * bottom / (top + bottom), N = P * l / (2.0 * h);
  const double sag = P * L * L * L / (3.0 * E * I) + n * 4.0 * N * N * l / (P * E * brace);
  EXPECT_NEAR(o.final("head.z"), -sag, 0.01 * sag);
  EXPECT_NEAR(o.final("top chord.N"), P * L / h, 0.01 * P * L / h);
}

}  // namespace
}  // namespace bough::verify
