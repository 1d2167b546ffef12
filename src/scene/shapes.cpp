#include "bough/scene/shapes.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace bough::scene {
namespace {

constexpr double pi = std::numbers::pi;

/// A ring between radii r < R; r = 0 is a full circle. Cowper's factor at nu = 0: 6 (1 + m^2)^2 / (7 (1 + m^2)^2 + 20 m^2), m = r / R.
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

Mat3 inertia(const Box& s, double m) {
  const Vec3 a = s.size;
  return diagonal(m * (a[1] * a[1] + a[2] * a[2]) / 12.0, m * (a[2] * a[2] + a[0] * a[0]) / 12.0,
                  m * (a[0] * a[0] + a[1] * a[1]) / 12.0);
}
Mat3 inertia(const Cylinder& s, double m) {
  return axial_inertia(s.axis, 0.5 * m * s.radius * s.radius,
                       m * (3.0 * s.radius * s.radius + s.length * s.length) / 12.0);
}
Mat3 inertia(const Sphere& s, double m) {
  const double j = 0.4 * m * s.radius * s.radius;
  return diagonal(j, j, j);
}
Mat3 inertia(const Rod& s, double m) { return axial_inertia(s.axis, 0.0, m * s.length * s.length / 12.0); }

double volume(const Box& s) { return s.size[0] * s.size[1] * s.size[2]; }
double volume(const Cylinder& s) { return pi * s.radius * s.radius * s.length; }
double volume(const Sphere& s) { return 4.0 / 3.0 * pi * s.radius * s.radius * s.radius; }
double volume(const Rod&) { return 0.0; }

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

Section make_section(const std::string& name, const SectionShape& shape, const Material& material,
                     std::optional<double> shear_factor_2, std::optional<double> shear_factor_3) {
  const AreaFigures f = area_figures(shape);
  const double E = material.young, G = material.shear, rho = material.density;
  const double stiffness[6] = {E * f.area,
                               shear_factor_2.value_or(f.shear_factor_2) * G * f.area,
                               shear_factor_3.value_or(f.shear_factor_3) * G * f.area,
                               G * f.torsion,
                               E * f.second_moment_2,
                               E * f.second_moment_3};
  Section s;
  s.name = name;
  s.stiffness = s.damping = Mat6::zero();
  for (int i = 0; i < 6; ++i) s.stiffness(i, i) = stiffness[i];
  const Vec3 rotary = {
      {rho * (f.second_moment_2 + f.second_moment_3), rho * f.second_moment_2, rho * f.second_moment_3}};
  s.mass = section_mass_matrix(rho * f.area, rotary, Vec3::zero());
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

double volume_of(const BodyShape& shape) {
  return std::visit([](const auto& s) { return volume(s); }, shape);
}

Mat3 inertia_of(const BodyShape& shape, double mass) {
  return std::visit([mass](const auto& s) { return inertia(s, mass); }, shape);
}

}  // namespace bough::scene
