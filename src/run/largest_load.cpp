#include "largest_load.hpp"

#include <cmath>
#include <unordered_map>

#include "bough/io/number_text.hpp"

namespace bough::run {

namespace {

struct Largest {
  double size = 0.0;  ///< [N]
  std::string text;
  void include(double new_size, const std::string& new_text) {
    if (!(new_size > size)) return;
    size = new_size;
    text = new_text;
  }
};

/// Absolute value of a load's law at a load factor; a load without a law is proportional to the load factor.
double factor_of(const laws::Law& law, double load_factor) {
  return std::abs(law.node() == nullptr ? load_factor : law.at(load_factor, laws::Side::left).value);
}

std::string named(const std::string& name) { return name.empty() ? "a load" : "'" + name + "'"; }

/// Includes the force and the moment at one place in the search for the largest load.
void include(Largest& largest, const std::string& name, const std::string& where, double force, double moment,
             double size) {
  const auto text = [&](double value, const char* unit) {
    return "the largest load is " + named(name) + ", " + io::rounded_text(value, 3) + unit + where;
  };
  largest.include(force, text(force, " N"));
  largest.include(moment / size, text(moment, " N m"));
}

std::string prescribed_motion(const scene::Scene& scene) {
  if (!scene.motions.empty())
    return "the motion that '" + scene.motions.front().name + "' prescribes to '" + scene.motions.front().at.to +
           "' loads it";
  for (const scene::Joint& joint : scene.joints)
    if (!joint.drives.empty()) return "the drive of joint '" + joint.name + "' loads it";
  return "";
}

}  // namespace

std::string largest_load(const scene::Scene& scene, const plan::Plan& plan, double load_factor, double mass) {
  Largest largest;
  for (const scene::PointLoad& l : scene.point_loads) {
    const double factor = factor_of(l.law, load_factor);
    include(largest, l.name, " at '" + l.at.to + "'", factor * length_of(l.force), factor * length_of(l.moment),
            plan.length_scale);
  }
  std::unordered_map<std::string, double> lengths;
  for (const plan::BeamPlan& beam : plan.beams) lengths[beam.name] = beam.length;
  for (const scene::LineLoad& l : scene.line_loads) {
    const double factor = lengths[l.beam] * factor_of(l.law, load_factor);
    include(largest, l.name, " on beam '" + l.beam + "'", factor * length_of(l.force), factor * length_of(l.moment),
            plan.length_scale);
  }
  const double weight = factor_of(scene.gravity_law, load_factor) * mass * length_of(scene.gravity);
  largest.include(weight, "the largest load is the weight, " + io::rounded_text(weight, 3) + " N in all");
  return largest.text.empty() ? prescribed_motion(scene) : largest.text;
}

}  // namespace bough::run
