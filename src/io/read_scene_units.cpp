/// Hints where numbers look as if they had units other than SI, although they may be intended.
#include <algorithm>
#include <cmath>

#include "bough/io/number_text.hpp"
#include "read_scene_impl.hpp"

namespace bough::io {

namespace {

constexpr double softest = 5e5, stiffest = 2e12;       ///< Young's moduli [Pa]: below rubber, above diamond
constexpr double lightest = 12.0, heaviest = 25e3;     ///< densities [kg/m^3]: below foams, above osmium
constexpr double metal = 5e10;                         ///< [Pa]
constexpr double thick_metal = 3.0, thick_wall = 1.0;  ///< [m]: no solid bar, no wall of a tube is as thick
constexpr double heavy = 1500.0, huge_body = 10.0;  ///< [kg/m^3], [m]: solid bodies of stone or metal are not as large
constexpr double stout = 5.0;                       ///< thickness over length: no beam any more

std::string metres(double x) { return rounded_text(x, 3) + " m"; }

}  // namespace

void Converter::warn_of_density(double density, const std::string& at, const std::string& name) {
  if (density == 0.0 || (density >= lightest && density <= heaviest)) return;
  warnings.push_back({at, "\"" + name + "\"",
                      "a density of " + rounded_text(density, 3) + " kg/m^3 is that of no solid",
                      "steel has 7850 kg/m^3 (7.85 g/cm^3, 7.85e-9 t/mm^3): is it in kg/m^3?"});
}

void Converter::warn_of_units(const scene::Material& m, const std::string& at) {
  if (m.young < softest || m.young > stiffest)
    warnings.push_back({at + "/young", "\"" + m.name + "\"",
                        "Young's modulus of " + rounded_text(m.young, 3) + " Pa is that of no solid",
                        "steel has 2.1e11 Pa (210000 MPa, 210 GPa): is it in Pa?"});
  warn_of_density(m.density, at + "/density", m.name);
}

void Converter::warn_of_thickness(const Value& shape, const scene::Material& m, const std::string& at) {
  if (m.young < metal) return;
  const double wall = number_or(shape, "outer_radius", 0.0) - number_or(shape, "inner_radius", 0.0);
  const double solid = std::min(std::max(number_or(shape, "width", 0.0), 2.0 * number_or(shape, "radius", 0.0)),
                                std::max(number_or(shape, "height", 0.0), 2.0 * number_or(shape, "radius", 0.0)));
  if (solid > thick_metal || wall > thick_wall)
    warnings.push_back({at + "/shape", "", "this is a solid metal section, " + metres(std::max(solid, wall)) + " thick",
                        "are its sizes in mm? they are asked for in metres"});
}

void Converter::warn_of_body_size(const Value& shape, const std::string& at, double density) {
  double size = std::max({number_or(shape, "length", 0.0), 2.0 * number_or(shape, "radius", 0.0)});
  if (const Value* edges = shape.find("size")) {
    const scene::Vec3 e = vector(*edges);
    size = std::max({size, e[0], e[1], e[2]});
  }
  if (density >= heavy && size > huge_body)
    warnings.push_back({at, "", "this is a solid body of stone or metal, " + metres(size) + " large",
                        "are its sizes in mm? they are asked for in metres"});
}

/// Warns of sections that are thicker than their beams are long.
void Converter::warn_of_thick_beams() {
  for (std::size_t i = 0; i < scene.beams.size(); ++i) {
    const scene::Beam& b = scene.beams[i];
    const auto known = thickness_.find(b.section);
    if (known == thickness_.end()) continue;
    const double length = poses_->length_of(b);
    if (length > 0.0 && known->second > stout * length)
      warnings.push_back(
          {pointers["beams"][i] + "/section", "\"" + b.section + "\"",
           "this section is " + metres(known->second) + " thick and the beam " + metres(length) + " long",
           "are its sizes in mm? they are asked for in metres"});
  }
}

/// Warns of a law that is constant at, or ends at, a whole number of degrees.
void Converter::warn_of_degrees(const laws::Law& angle, const std::string& at) {
  if (!angle.is_constant() && !is_static_) return;  // in time a drive may make any number of turns
  const double x = std::abs(angle.at(is_static_ ? 1.0 : 0.0).value);
  if (x > largest_angle)
    fault(at, "this angle is too large: no digit of it tells a direction", "angles are in rad");
  else if (x >= 15.0 && std::fmod(x, 5.0) == 0.0)
    warnings.push_back({at, "", "this angle is in radians (rad): it reaches " + rounded_text(x, 3),
                        "for degrees multiply by pi/180 = 0.017453292519943295"});
}

}  // namespace bough::io
