#include "bough/scene/shapes.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "bough/scene/outlines.hpp"
#include "profiles.hpp"

namespace bough::scene {
namespace {

constexpr double pi = std::numbers::pi;

/// A ring between radii r < R; r = 0 is a full circle. Cowper's factor at nu = 0: 6 (1 + m^2)^2 / (7 (1 + m^2)^2 + 20
/// m^2), m = r / R.
AreaFigures ring_figures(double R, double r) {
  AreaFigures f;
  f.area = pi * (R - r) * (R + r);
  f.second_moment_2 = f.second_moment_3 = 0.25 * f.area * (R * R + r * r);
  f.torsion = 2.0 * f.second_moment_2;
  const double m = r / R, q = (1.0 + m * m) * (1.0 + m * m);
  f.shear_factor_2 = f.shear_factor_3 = 6.0 * q / (7.0 * q + 20.0 * m * m);
  return f;
}

AreaFigures figures(const Rectangle& s) {
  AreaFigures f;
  f.area = s.width * s.height;
  f.second_moment_2 = f.area * s.height * s.height / 12.0;
  f.second_moment_3 = f.area * s.width * s.width / 12.0;
  f.torsion = rectangle_torsion_constant(std::max(s.width, s.height), std::min(s.width, s.height));
  f.shear_factor_2 = f.shear_factor_3 = 5.0 / 6.0;
  return f;
}
/// J = pi a^3 b^3 / (a^2 + b^2); Cowper's factor at nu = 0 for a force along a: 3 (3 n^2 + 1) / (10 n^2 + 4), n = a /
/// b.
AreaFigures figures(const Ellipse& s) {
  const double a = 0.5 * s.width, b = 0.5 * s.height;
  AreaFigures f;
  f.area = pi * a * b;
  f.second_moment_2 = 0.25 * f.area * b * b;
  f.second_moment_3 = 0.25 * f.area * a * a;
  f.torsion = pi * a * a * a * b * b * b / (a * a + b * b);
  const auto factor = [](double n) { return 3.0 * (3.0 * n * n + 1.0) / (10.0 * n * n + 4.0); };
  f.shear_factor_2 = factor(a / b);
  f.shear_factor_3 = factor(b / a);
  return f;
}

/// Area and second moments of an outline; nothing of shear and torsion.
AreaFigures outline_figures(const Outline& outline) {
  const PolygonMoments m = moments_of(centered(outline));
  AreaFigures f;
  f.area = m.area;
  f.second_moment_2 = m.square_3;
  f.second_moment_3 = m.square_2;
  f.product_moment = m.product;
  return f;
}
AreaFigures figures(const Polygon& s) { return outline_figures(s.outline); }

/// (k2, k23; k23, k3) A = (G S)^-1.
void set_shear(AreaFigures& f, double S22, double S33, double S23) {
  const double determinant = (S22 * S33 - S23 * S23) * f.area;
  f.shear_factor_2 = S33 / determinant;
  f.shear_factor_3 = S22 / determinant;
  f.shear_factor_23 = -S23 / determinant;
}

AreaFigures figures(const HollowBox& s) {
  AreaFigures f = outline_figures(outline_of(s));
  const double a = s.width - s.thickness, b = s.height - s.thickness;
  f.torsion = 2.0 * s.thickness * a * a * b * b / (a + b);
  set_shear(f, eval_walls(walls_of(s, false)).compliance_22, eval_walls(walls_of(s, true)).compliance_33, 0.0);
  return f;
}

template <class Profile>
AreaFigures open_figures(const Profile& s) {
  AreaFigures f = outline_figures(outline_of(s));
  const WallFigures w = eval_walls(walls_of(s));
  f.torsion = w.open_torsion;
  f.shear_center_2 = w.shear_center_2;
  f.shear_center_3 = w.shear_center_3;
  set_shear(f, w.compliance_22, w.compliance_33, w.compliance_23);
  return f;
}
AreaFigures figures(const IProfile& s) {
  AreaFigures f = open_figures(s);  // entries that vanish by symmetry are set to exactly 0, free of round-off
  f.shear_center_2 = f.shear_center_3 = f.shear_factor_23 = f.product_moment = 0.0;
  return f;
}
AreaFigures figures(const CProfile& s) {
  AreaFigures f = open_figures(s);
  f.shear_center_3 = f.shear_factor_23 = f.product_moment = 0.0;
  return f;
}
AreaFigures figures(const LProfile& s) { return open_figures(s); }

AreaFigures figures(const Circle& s) { return ring_figures(s.radius, 0.0); }
AreaFigures figures(const Tube& s) { return ring_figures(s.outer_radius, s.inner_radius); }

Mat3 diagonal(double a, double b, double c) {
  Mat3 r = Mat3::zero();
  r(0, 0) = a;
  r(1, 1) = b;
  r(2, 2) = c;
  return r;
}

Mat3 axial_inertia(int axis, double along, double across) {
  Mat3 r = diagonal(across, across, across);
  r(axis - 1, axis - 1) = along;
  return r;
}

Mat3 inertia_by_axes(const Box& s, double m) {
  const Vec3 a = s.size;
  return diagonal(m * (a[1] * a[1] + a[2] * a[2]) / 12.0, m * (a[2] * a[2] + a[0] * a[0]) / 12.0,
                  m * (a[0] * a[0] + a[1] * a[1]) / 12.0);
}
Mat3 inertia_by_axes(const Cylinder& s, double m) {
  return axial_inertia(s.axis, 0.5 * m * s.radius * s.radius,
                       m * (3.0 * s.radius * s.radius + s.length * s.length) / 12.0);
}
Mat3 inertia_by_axes(const Sphere& s, double m) {
  const double j = 0.4 * m * s.radius * s.radius;
  return diagonal(j, j, j);
}
Mat3 inertia_by_axes(const Ring& s, double m) {
  const double squares = s.outer_radius * s.outer_radius + s.inner_radius * s.inner_radius;
  return axial_inertia(s.axis, 0.5 * m * squares, m * (3.0 * squares + s.length * s.length) / 12.0);
}
/// A cylinder and two half spheres, whose centres of mass lie 3/8 of the radius beyond its ends.
Mat3 inertia_by_axes(const Capsule& s, double m) {
  const double r = s.radius, L = s.length, ends = m * 4.0 * r / (3.0 * L + 4.0 * r), middle = m - ends;
  const double across = middle * (3.0 * r * r + L * L) / 12.0 + ends * (0.4 * r * r + 0.25 * L * L + 0.375 * L * r);
  return axial_inertia(s.axis, 0.5 * middle * r * r + 0.4 * ends * r * r, across);
}
/// Discs along the axis, r from R to q: I_axial = 3/10 m (R^5 - q^5) / (R^3 - q^3), written without the difference.
Mat3 inertia_by_axes(const Cone& s, double m) {
  const double R = s.radius, q = s.end_radius, h = center_height(s), L = s.length;
  const double cubes = R * R + R * q + q * q,
               fifths = R * R * R * R + R * R * R * q + R * R * q * q + R * q * q * q + q * q * q * q;
  const double along = 0.3 * m * fifths / cubes;
  // int z^2 dm about the large end: L^2 (R^2 + 3 R q + 6 q^2) / (10 (R^2 + R q + q^2))
  const double squares = m * L * L * (R * R + 3.0 * R * q + 6.0 * q * q) / (10.0 * cubes);
  return axial_inertia(s.axis, along, 0.5 * along + squares - m * h * h);
}
Mat3 inertia_by_axes(const Extrusion& s, double m) {
  const PolygonMoments p = moments_of(centered(s.outline));
  const double c2 = m * p.square_2 / p.area, c3 = m * p.square_3 / p.area, c23 = m * p.product / p.area;
  const double l = m * s.length * s.length / 12.0;
  const int a = s.axis - 1, b = (a + 1) % 3, c = (a + 2) % 3;
  Mat3 J = Mat3::zero();
  J(a, a) = c2 + c3;
  J(b, b) = c3 + l;
  J(c, c) = c2 + l;
  J(b, c) = J(c, b) = -c23;
  return J;
}
Mat3 inertia_by_axes(const Rod& s, double m) { return axial_inertia(s.axis, 0.0, m * s.length * s.length / 12.0); }

double volume(const Box& s) { return s.size[0] * s.size[1] * s.size[2]; }
double volume(const Cylinder& s) { return pi * s.radius * s.radius * s.length; }
double volume(const Sphere& s) { return 4.0 / 3.0 * pi * s.radius * s.radius * s.radius; }
double volume(const Rod&) { return 0.0; }
double volume(const Capsule& s) { return pi * s.radius * s.radius * (s.length + 4.0 / 3.0 * s.radius); }
double volume(const Cone& s) {
  return pi / 3.0 * s.length * (s.radius * s.radius + s.radius * s.end_radius + s.end_radius * s.end_radius);
}
double volume(const Ring& s) {
  return pi * (s.outer_radius - s.inner_radius) * (s.outer_radius + s.inner_radius) * s.length;
}
double volume(const Extrusion& s) { return moments_of(s.outline).area * s.length; }

}  // namespace

double rectangle_torsion_constant(double a, double b) {
  double sum = 0.0;
  for (int n = 4001; n >= 1; n -= 2)  // small terms first; the rest after n = 4001 is below 1e-15 of the sum
    sum += std::tanh(0.5 * n * pi * a / b) / (static_cast<double>(n) * n * n * n * n);
  return a * b * b * b * (1.0 / 3.0 - 64.0 / (pi * pi * pi * pi * pi) * (b / a) * sum);
}

AreaFigures area_figures(const SectionShape& shape) {
  return std::visit([](const auto& s) { return figures(s); }, shape);
}

Section make_section(const std::string& name, const SectionShape& shape, const AreaFigures& f,
                     const Material& material) {
  const double E = material.young, G = material.shear, rho = material.density;
  const double e2 = f.shear_center_2, e3 = f.shear_center_3;
  Section s;
  s.name = name;
  s.shape = shape;
  s.stiffness = s.damping = Mat6::zero();
  Mat6& K = s.stiffness;
  const auto set = [](Mat6& M, int i, int j, double value) { M(i, j) = M(j, i) = value; };
  const double k22 = f.shear_factor_2 * G * f.area, k33 = f.shear_factor_3 * G * f.area;
  const double k23 = f.shear_factor_23 * G * f.area;
  set(K, 0, 0, E * f.area);
  set(K, 1, 1, k22);
  set(K, 2, 2, k33);
  set(K, 1, 2, k23);
  set(K, 1, 3, -e3 * k22 + e2 * k23);
  set(K, 2, 3, -e3 * k23 + e2 * k33);
  set(K, 3, 3, G * f.torsion + e3 * e3 * k22 - 2.0 * e2 * e3 * k23 + e2 * e2 * k33);
  set(K, 4, 4, E * f.second_moment_2);
  set(K, 5, 5, E * f.second_moment_3);
  set(K, 4, 5, -E * f.product_moment);
  const Vec3 rotary = {
      {rho * (f.second_moment_2 + f.second_moment_3), rho * f.second_moment_2, rho * f.second_moment_3}};
  s.mass = section_mass_matrix(rho * f.area, rotary, Vec3::zero());
  if (f.product_moment != 0.0) set(s.mass, 4, 5, -rho * f.product_moment);
  return s;
}

Mat6 section_mass_matrix(double mass_per_length, const Vec3& rotary, const Vec3& center) {
  Mat6 M = Mat6::zero();
  const Mat3 c = lanes::skew(center), cc = c * c;
  for (int i = 0; i < 3; ++i) {
    M(i, i) = mass_per_length;
    M(i + 3, i + 3) = rotary[i];
    for (int j = 0; j < 3; ++j) {
      M(i, j + 3) = -mass_per_length * c(i, j);
      M(i + 3, j) = mass_per_length * c(i, j);
      M(i + 3, j + 3) -= mass_per_length * cc(i, j);
    }
  }
  return M;
}

double center_height(const Cone& s) {
  const double R = s.radius, q = s.end_radius;
  return 0.25 * s.length * (R * R + 2.0 * R * q + 3.0 * q * q) / (R * R + R * q + q * q);
}

double volume_of(const BodyShape& shape) {
  return std::visit([](const auto& s) { return volume(s); }, shape);
}

Mat3 inertia_of(const BodyShape& shape, double mass) {
  return std::visit([mass](const auto& s) { return inertia_by_axes(s, mass); }, shape);
}

}  // namespace bough::scene
