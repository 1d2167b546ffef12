/// Numbers that are unlikely in SI units and probably given in other units, or too large to compute with.
#include <algorithm>
#include <cmath>

#include "bough/scene/couplings.hpp"
#include "problem_list.hpp"

namespace bough::scene {
namespace {

/// Above this, squares and products overflow.
constexpr double computable = 1e100;

struct Quantity {
  const char* what;
  const char* unit;
  double odd;  ///< values above this are probably not meant
};

constexpr Quantity force{"a force", "N", 1e15}, line_force{"a line load", "N/m", 1e15}, moment{"a moment", "N m", 1e15},
    line_moment{"a line load", "N", 1e15}, gravity{"a gravity", "m/s^2", 1e3}, place{"a place", "m", 1e15},
    velocity{"a speed", "m/s", 3e8}, turning{"an angular velocity", "rad/s", 1e12}, mass{"a mass", "kg", 1e30},
    inertia{"an inertia", "kg m^2", 1e40}, stiffness{"a stiffness", "N/m, N or N m^2", 1e20},
    damping{"a damping", "N s/m", 1e20};

void judge(ProblemList& list, const char* section, std::size_t i, const char* key, const std::string& name, double x,
           const Quantity& q) {
  const std::string told = std::string(q.what) + " of " + text_of(x) + " " + q.unit;
  if (!(x <= computable))
    list.add(section, i, key, name, told + " is too large to be computed with", "units are SI: " + std::string(q.unit));
  else if (x > q.odd)
    list.warn(section, i, key, name, told + " is very large: is it meant?", "units are SI: " + std::string(q.unit));
}

double largest_entry(std::span<const double> a) {
  double most = 0.0;
  for (const double x : a) most = std::max(most, std::abs(x));
  return most;
}

/// Largest magnitude of a law over the analysis, by samples; 1 where no law is given.
double largest_factor(const ProblemList& list, const laws::Law& law) {
  if (law.node() == nullptr) return 1.0;
  constexpr int samples = 16;
  double most = 0.0;
  for (int k = 0; k <= samples; ++k) {
    const double value = std::abs(law.at(std::isfinite(list.last_time) ? list.last_time * k / samples : 0.0).value);
    if (std::isfinite(value)) most = std::max(most, value);  // infinite values are reported by another check
  }
  return most;
}

void check_load_sizes(ProblemList& list) {
  const Scene& s = list.scene;
  for (std::size_t i = 0; i < s.point_loads.size(); ++i) {
    const PointLoad& l = s.point_loads[i];
    const double factor = largest_factor(list, l.law);
    judge(list, "point_loads", i, "force", l.name, factor * norm(l.force), force);
    judge(list, "point_loads", i, "moment", l.name, factor * norm(l.moment), moment);
  }
  for (std::size_t i = 0; i < s.line_loads.size(); ++i) {
    const LineLoad& l = s.line_loads[i];
    const double factor = largest_factor(list, l.law);
    judge(list, "line_loads", i, "force", l.name, factor * norm(l.force), line_force);
    judge(list, "line_loads", i, "moment", l.name, factor * norm(l.moment), line_moment);
  }
  judge(list, "gravity", 0, "", "", largest_factor(list, s.gravity_law) * norm(s.gravity), gravity);
}

void check_stiffness_sizes(ProblemList& list) {
  const Scene& s = list.scene;
  for (std::size_t i = 0; i < s.sections.size(); ++i) {
    judge(list, "sections", i, "stiffness", s.sections[i].name, largest_entry(s.sections[i].stiffness.m), stiffness);
    judge(list, "sections", i, "mass", s.sections[i].name, largest_entry(s.sections[i].mass.m), mass);
    judge(list, "sections", i, "damping", s.sections[i].name, largest_entry(s.sections[i].damping.m), damping);
  }
  constexpr double odd = 1e20;
  for (std::size_t i = 0; i < s.couplings.size(); ++i)
    for_each_field(s.couplings[i], [&](const CouplingField& field, std::span<const double> values, const Factor*) {
      if (field.type == CouplingFieldType::number || field.type == CouplingFieldType::matrix)
        judge(list, "couplings", i, field.name, s.couplings[i].name, largest_entry(values),
              {(std::string("the ") + field.name).c_str(), field.unit, odd});
    });
  for (std::size_t i = 0; i < s.joints.size(); ++i)
    for (std::size_t k = 0; k < s.joints[i].forces.size(); ++k) {
      const JointForce& f = s.joints[i].forces[k];
      const std::string at = "forces/" + std::to_string(k);
      judge(list, "joints", i, (at + "/stiffness").c_str(), s.joints[i].name, f.stiffness, stiffness);
      judge(list, "joints", i, (at + "/damping").c_str(), s.joints[i].name, f.damping, damping);
      if (f.effort.node() != nullptr)
        judge(list, "joints", i, (at + "/effort").c_str(), s.joints[i].name, largest_factor(list, f.effort), moment);
    }
}

void check_places(ProblemList& list) {
  const Scene& s = list.scene;
  for (std::size_t i = 0; i < s.nodes.size(); ++i)
    judge(list, "nodes", i, "position", s.nodes[i].name, norm(s.nodes[i].placement.pose.x), place);
  for (std::size_t i = 0; i < s.bodies.size(); ++i) {
    const Body& b = s.bodies[i];
    judge(list, "bodies", i, "position", b.name, norm(b.placement.pose.x), place);
    judge(list, "bodies", i, "center_of_mass", b.name, norm(b.center_of_mass), place);
    judge(list, "bodies", i, "mass", b.name, b.mass, mass);
    judge(list, "bodies", i, "inertia", b.name, std::max({b.inertia(0, 0), b.inertia(1, 1), b.inertia(2, 2)}), inertia);
  }
  for (std::size_t i = 0; i < s.initial_velocities.size(); ++i) {
    const InitialVelocity& v = s.initial_velocities[i];
    judge(list, "initial_velocities", i, "velocity", v.of, norm(v.velocity), velocity);
    judge(list, "initial_velocities", i, "angular_velocity", v.of, norm(v.angular_velocity), turning);
  }
}

/// Finds sections whose axial stiffness exceeds the bending stiffness so much that bending is lost in round-off.
void check_slenderness(ProblemList& list, std::size_t i) {
  constexpr double digits = 1e18;  // twice those of a number: slender to 1e9
  const Beam& b = list.scene.beams[i];
  const auto section = list.section_of.find(b.section);
  if (section == list.section_of.end()) return;
  const Mat6& k = list.scene.sections[section->second].stiffness;
  const double length = list.poses.length_of(b), straining = std::max({k(0, 0), k(1, 1), k(2, 2)}) * length * length;
  const double bending = std::min({k(3, 3), k(4, 4), k(5, 5)});
  if (straining > digits * bending)
    list.warn("beams", i, "section", b.section,
              "this beam is " + text_of(straining / bending) +
                  " times as stiff in stretching as it is soft in bending or torsion (EA L^2 / EI): no digit is left",
              "look at the stiffness of the section");
}

}  // namespace

void check_magnitudes(ProblemList& list) {
  check_load_sizes(list);
  check_stiffness_sizes(list);
  check_places(list);
  for (std::size_t i = 0; i < list.scene.beams.size(); ++i) check_slenderness(list, i);
}

}  // namespace bough::scene
