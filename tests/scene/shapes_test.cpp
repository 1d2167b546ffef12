/// Sections and bodies from their shapes, against closed forms, published tables and sums over small parts.
#include "bough/scene/shapes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>

#include "bough/scene/outlines.hpp"

namespace bough::scene {
namespace {

using std::numbers::pi;

/// Every kind of section, none with equal sides.
std::vector<SectionShape> sections() {
  Outline kite{{{{0, 0}, {3, -1}, {5, 2}, {1, 4}}, {{2, 1}, {2, 2}, {3, 2}, {3, 1}}}};
  return {Rectangle{0.3, 0.2},
          Circle{0.1},
          Tube{0.1, 0.08},
          Ellipse{0.4, 0.2},
          HollowBox{0.3, 0.2, 0.01},
          IProfile{0.1, 0.2, 0.0056, 0.0085},
          CProfile{0.1, 0.2, 0.006, 0.01},
          LProfile{0.1, 0.15, 0.01},
          Polygon{kite}};
}

TEST(Sections, torsion_constants_of_rectangles_are_those_of_the_published_table) {
  // Timoshenko, Goodier, Theory of elasticity, 3rd edition, section 109: k1 of J = k1 (2a)^3 2b, by b/a.
  const std::pair<double, double> table[] = {{1.0, 0.1406}, {1.2, 0.166}, {1.5, 0.196}, {2.0, 0.229}, {2.5, 0.249},
                                             {3.0, 0.263},  {4.0, 0.281}, {5.0, 0.291}, {10.0, 0.312}};
  for (const auto& [ratio, k1] : table)
    EXPECT_NEAR(area_figures(Rectangle{1.0, ratio}).torsion / ratio, k1, k1 == 0.1406 ? 5e-5 : 7e-4) << ratio;
}

TEST(Sections, an_ellipse_with_equal_axes_is_a_circle) {
  const AreaFigures e = area_figures(Ellipse{0.2, 0.2}), c = area_figures(Circle{0.1});
  for (const auto& [a, b] : {std::pair{e.area, c.area},
                             {e.second_moment_2, c.second_moment_2},
                             {e.torsion, c.torsion},
                             {e.shear_factor_2, c.shear_factor_2},
                             {e.shear_factor_3, c.shear_factor_3}})
    EXPECT_NEAR(a, b, 1e-14 * std::abs(b));
  EXPECT_NEAR(area_figures(Ellipse{0.4, 0.2}).torsion, pi * 0.008 * 0.001 / 0.05, 1e-18);
  EXPECT_NEAR(area_figures(Ellipse{1e-4, 1.0}).shear_factor_3, 0.9, 1e-6) << "a narrow ellipse, force along it";
}

TEST(Sections, profiles_have_the_area_and_second_moments_of_their_rectangles) {
  const double w = 0.1, h = 0.2, t = 0.0056, f = 0.0085;
  const AreaFigures i = area_figures(IProfile{w, h, t, f});
  EXPECT_NEAR(i.area, w * h - (w - t) * (h - 2 * f), 1e-17);
  EXPECT_NEAR(i.second_moment_2, (w * h * h * h - (w - t) * std::pow(h - 2 * f, 3)) / 12.0, 1e-18);
  EXPECT_NEAR(i.second_moment_3, (2 * f * w * w * w + (h - 2 * f) * t * t * t) / 12.0, 1e-18);
  const AreaFigures box = area_figures(HollowBox{w, h, f});
  EXPECT_NEAR(box.second_moment_2, (w * h * h * h - (w - 2 * f) * std::pow(h - 2 * f, 3)) / 12.0, 1e-18);
  const double l = 0.1, s = 0.01;  // an angle of equal legs: principal axes at 45 degrees
  const AreaFigures angle = area_figures(LProfile{l, l, s});
  EXPECT_NEAR(angle.area, s * (2 * l - s), 1e-18);
  EXPECT_NEAR(angle.second_moment_2, angle.second_moment_3, 1e-18);
  EXPECT_LT(angle.product_moment, 0.0) << "most of it lies where one coordinate is above and the other below 0";
}

TEST(Sections, shear_of_thin_walls_meets_closed_forms) {
  // A web alone: the flow is a parabola, k = 5/6. Flanges of no thickness leave it.
  EXPECT_NEAR(area_figures(IProfile{0.02, 1.0, 0.01, 1e-9}).shear_factor_3, 5.0 / 6.0, 1e-6);
  // Shear centre of a channel of thin walls, from the middle of its web: e = 3 b^2 f / (h t + 6 b f), to the outside
  // (Timoshenko, Strength of materials I, article 53).
  const double t = 1e-5, f = 2e-5, b = 0.1, h = 0.2;
  const AreaFigures c = area_figures(CProfile{b + t / 2, h + f, t, f});
  const double centroid = b * b * f / (2 * b * f + h * t);  // of the middle lines, from the web's
  EXPECT_NEAR(c.shear_center_2, -centroid - 3 * b * b * f / (h * t + 6 * b * f), 1e-9);
  EXPECT_EQ(c.shear_center_3, 0.0);
  // Of an angle: where its legs meet.
  const AreaFigures l = area_figures(LProfile{0.1, 0.15, 1e-5});
  const Outline outline = outline_of(LProfile{0.1, 0.15, 1e-5});
  EXPECT_NEAR(l.shear_center_2, outline.loops[0][0][0], 2e-5);
  EXPECT_NEAR(l.shear_center_3, outline.loops[0][0][1], 2e-5);
  // A thin square tube: half its area takes the force in webs, k by the flow: 1/(A) (I^2 / int S^2/t) = 20/48.
  EXPECT_NEAR(area_figures(HollowBox{1.0, 1.0, 1e-6}).shear_factor_2, 5.0 / 12.0, 1e-5);
  EXPECT_NEAR(area_figures(HollowBox{1.0, 1.0, 1e-6}).torsion, 1e-6, 1e-11) << "Bredt: t a^3";
}

TEST(Sections, stiffness_with_an_offset_shear_centre_is_positive_and_bends_without_twist_there) {
  Material steel{"steel", 2.1e11, 8.1e10, 7850};
  const CProfile shape{0.1, 0.2, 0.006, 0.01};
  const AreaFigures f = area_figures(shape);
  const Section s = make_section("c", shape, f, steel);
  EXPECT_EQ(s.stiffness(1, 3), s.stiffness(3, 1));
  // A force along axis 3 through the shear centre: T about the centroid is e2 Q3, and the section does not twist.
  const double g3 = 1e-4;
  const double Q3 = s.stiffness(2, 2) * g3, T = s.stiffness(3, 2) * g3;
  EXPECT_NEAR(T, f.shear_center_2 * Q3, 1e-12 * std::abs(T));
  EXPECT_GT(s.stiffness(3, 3) * s.stiffness(2, 2) - s.stiffness(2, 3) * s.stiffness(2, 3), 0.0);
}

TEST(Outlines, enclose_the_area_of_the_section_about_its_centroid) {
  for (const SectionShape& shape : sections()) {
    const Outline outline = outline_of(shape);
    const PolygonMoments m = moments_of(outline);
    const AreaFigures f = area_figures(shape);
    EXPECT_EQ(problem_in(outline), "") << shape.index();
    EXPECT_NEAR(m.area, f.area, 1e-12 * f.area) << shape.index();
    EXPECT_NEAR(m.first_2, 0.0, 1e-12 * f.area) << shape.index();
    EXPECT_NEAR(m.first_3, 0.0, 1e-12 * f.area) << shape.index();
  }
}

TEST(Outlines, triangles_fill_them_and_no_more) {
  std::vector<Outline> all;
  for (const SectionShape& shape : sections()) all.push_back(outline_of(shape));
  Outline star;  // a star of ten corners with two holes
  star.loops.emplace_back();
  for (int k = 0; k < 20; ++k) {
    const double r = k % 2 == 0 ? 2.0 : 1.1, a = 2.0 * pi * k / 20.0;
    star.loops[0].push_back({r * std::cos(a), r * std::sin(a)});
  }
  star.loops.push_back({{0.1, 0.1}, {0.1, 0.4}, {0.4, 0.4}, {0.4, 0.1}});
  star.loops.push_back({{-0.5, -0.5}, {-0.5, -0.2}, {-0.2, -0.2}, {-0.2, -0.5}});
  all.push_back(star);
  for (const Outline& outline : all) {
    ASSERT_EQ(problem_in(outline), "");
    const Triangulation t = triangles_of(outline);
    double sum = 0.0;
    for (const auto& c : t.triangles) {
      const auto &a = t.points[static_cast<std::size_t>(c[0])], &b = t.points[static_cast<std::size_t>(c[1])],
                 &d = t.points[static_cast<std::size_t>(c[2])];
      const double twice = (b[0] - a[0]) * (d[1] - a[1]) - (b[1] - a[1]) * (d[0] - a[0]);
      EXPECT_GT(twice, 0.0);
      sum += 0.5 * twice;
    }
    const double area = moments_of(outline).area;
    EXPECT_NEAR(sum, area, 1e-12 * area);
  }
}

TEST(Outlines, what_is_wrong_with_one_is_told) {
  using Loops = decltype(Outline::loops);
  const std::pair<Loops, const char*> cases[] = {
      {{}, "three corners"},
      {{{{0, 0}, {1, 0}}}, "three corners"},
      {{{{0, 0}, {0, 1}, {1, 0}}}, "clockwise"},
      {{{{0, 0}, {1, 1}, {1, 0}, {0, 1}}}, "cross"},
      {{{{0, 0}, {1, 0}, {1, 0}, {0, 1}}}, "twice"},
      {{{{0, 0}, {1, 0}, {0, std::nan("")}}}, "finite"},
      {{{{0, 0}, {1, 0}, {1, 1}, {0, 1}}, {{0.2, 0.2}, {0.8, 0.2}, {0.5, 0.5}}}, "hole"},
      {{{{0, 0}, {1, 0}, {1, 1}, {0, 1}}, {{0.2, 0.2}, {0.5, 1.5}, {0.8, 0.2}}}, "cross"},
  };
  for (const auto& [loops, words] : cases) EXPECT_NE(problem_in({loops}).find(words), std::string::npos) << words;
}

std::vector<BodyShape> bodies() {
  return {Box{{{1, 2, 3}}},
          Cylinder{0.3, 1.0, 2},
          Sphere{0.4},
          Capsule{0.3, 1.0, 3},
          Cone{0.5, 0.2, 1.0, 1},
          Cone{0.5, 0.0, 1.0, 3},
          Ring{0.5, 0.3, 0.2, 2},
          Extrusion{{{{{0, 0}, {2, 0}, {0, 1}}}}, 0.5, 2}};
}

/// Volume, centre and inertia of a closed surface of unit density, by tetrahedra from the origin to its triangles.
struct Solid {
  double volume = 0.0, first[3] = {}, second[3][3] = {};
  explicit Solid(const Mesh& mesh) {
    for (const auto& t : mesh.triangles) {
      const std::array<double, 3>* p[3];
      for (std::size_t k = 0; k < 3; ++k) p[k] = &mesh.points[static_cast<std::size_t>(t[k])];
      const auto &a = *p[0], &b = *p[1], &c = *p[2];
      const double v = (a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
                        a[2] * (b[0] * c[1] - b[1] * c[0])) /
                       6.0;
      volume += v;
      for (std::size_t i = 0; i < 3; ++i) {
        const double sum = a[i] + b[i] + c[i];
        first[i] += v * sum / 4.0;
        for (std::size_t j = 0; j < 3; ++j)
          second[i][j] += v * (a[i] * a[j] + b[i] * b[j] + c[i] * c[j] + sum * (a[j] + b[j] + c[j])) / 20.0;
      }
    }
  }
};

TEST(Bodies, surfaces_enclose_the_volume_around_the_centre_of_mass) {
  for (const BodyShape& shape : bodies()) {
    const Solid s(mesh_of(shape));
    const double size = std::cbrt(s.volume);
    // A frustum of the polygon has exactly the volume of the round one but for a tip of a millionth.
    EXPECT_NEAR(s.volume, volume_of(shape), 3e-6 * s.volume) << shape.index();
    for (const double x : s.first) EXPECT_NEAR(x, 0.0, 2e-6 * s.volume * size) << shape.index();
  }
}

TEST(Bodies, surfaces_are_closed_every_edge_is_run_through_once_in_either_direction) {
  for (const BodyShape& shape : bodies()) {
    std::map<std::pair<int, int>, int> edges;
    for (const auto& t : mesh_of(shape).triangles)
      for (std::size_t k = 0; k < 3; ++k) ++edges[{t[k], t[(k + 1) % 3]}];
    for (const auto& [edge, count] : edges) {
      EXPECT_EQ(count, 1) << shape.index();
      EXPECT_TRUE(edges.contains({edge.second, edge.first})) << shape.index();
    }
  }
}

TEST(Bodies, inertia_is_that_of_the_enclosed_mass) {
  for (const BodyShape& shape : bodies()) {
    const Solid s(mesh_of(shape));
    const Mat3 J = inertia_of(shape, s.volume);
    const double trace = s.second[0][0] + s.second[1][1] + s.second[2][2];
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        // Polygons of 24 sides stand for circles: their second moments are 4e-5 larger at the same area, spheres 1 %.
        EXPECT_NEAR(J(i, j), (i == j ? trace : 0.0) - s.second[i][j], 1.2e-2 * trace) << shape.index() << i << j;
  }
  const Solid prism(mesh_of(Extrusion{{{{{0, 0}, {2, 0}, {0, 1}}}}, 0.5, 2}));
  const Mat3 J = inertia_of(Extrusion{{{{{0, 0}, {2, 0}, {0, 1}}}}, 0.5, 2}, prism.volume);
  EXPECT_NEAR(J(2, 0), -prism.second[2][0], 1e-15) << "of flat faces exactly";
}

}  // namespace
}  // namespace bough::scene
