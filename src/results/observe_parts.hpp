#pragma once
/// Shared by the files of observe.hpp.
#include <algorithm>
#include <utility>

#include "bough/results/observe.hpp"

namespace bough::results {

/// Motion of a material point with its axes, in the ground: pose, twist and its derivative in its own axes.
struct PointMotion {
  motion::Frame<double> pose;
  motion::Vec6<double> v, a;
};

PointMotion motion_of_port(const elements::Port& port, const elements::Field& field);

/// Motion of the point that a sensor names, of a part or of a beam's axis.
PointMotion motion_at(const step::System& system, const step::State& state, const plan::SensorPlan& s);
/// Section resultants and strains at the station that a sensor names, in section axes.
motion::Vec6<double> section_force_at(const step::System& system, const step::State& state, const plan::SensorPlan& s);
motion::Vec6<double> section_strain_at(const step::System& system, const step::State& state, const plan::SensorPlan& s);
/// The extremes along a beam of the section resultant that a sensor names. Each element is looked at in eight intervals
/// and on both sides of its nodes; a parabola through three neighbours finds the place between them, so that extremes
/// are exact under uniform loads.
struct SectionExtremes {
  double least, largest, least_at, largest_at;  ///< values, and stations of the beam
};
SectionExtremes section_extremes(const step::System& system, const step::State& state, const plan::SensorPlan& s);

inline void append(std::vector<double>& to, const motion::Vec3<double>& v) { to.insert(to.end(), v.v, v.v + 3); }
inline void append(std::vector<double>& to, const motion::Vec6<double>& v) { to.insert(to.end(), v.v, v.v + 6); }

/// Element of a beam and local parameter at a station (fraction of the beam).
inline std::pair<int, double> locate(const plan::BeamPlan& beam, double station) {
  const double at = station * static_cast<double>(beam.elements.size());
  const int k = std::clamp(static_cast<int>(at), 0, static_cast<int>(beam.elements.size()) - 1);
  return {k, at - k};
}

/// Transforms both halves of a 6-vector to other axes.
inline motion::Vec6<double> turned(const motion::Mat3<double>& R, const motion::Vec6<double>& v) {
  return lanes::join(R * lanes::linear_part(v), R * lanes::angular_part(v));
}
/// A twist or wrench given in its own axes, resolved in space axes or in its own.
inline motion::Vec6<double> resolve(const motion::Mat3<double>& R, const motion::Vec6<double>& v,
                                    scene::LoadAxes axes) {
  return axes == scene::LoadAxes::body ? v : turned(R, v);
}

/// Position of a port in the frame of the scene.
inline motion::Vec3<double> position_of(const elements::Field& f, const elements::Port& port) {
  if (port.carrier >= 0) return motion::transform(f.carriers[port.carrier].pose, port.offset.x);
  if (port.node == elements::ground) return port.offset.x;
  const elements::NodeMotion& n = f.nodes[port.node];
  return n.x.hi + n.x.lo + (port.has_offset ? n.R * port.offset.x : motion::Vec3<double>::zero());
}

}  // namespace bough::results
