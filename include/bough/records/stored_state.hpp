#pragma once
/// The motion of a structure at one time, by the names of its parts, so that another scene can start from it.
#include <array>
#include <string>
#include <vector>

#include "bough/records/archive.hpp"

namespace bough::records {

/// A node, a body or an inner node of a beam ("<beam>.<k>"). Place and axes are those in the ground, or in the frame of
/// the analysis; velocities are in the part's own axes.
struct StoredPart {
  std::string name;
  std::array<double, 3> position{}, rest{};  ///< position + rest [m]: the digits that one number does not hold
  std::array<double, 4> rotation{};          ///< unit quaternion, scalar first
  std::array<double, 3> velocity{};          ///< of the part's origin [m/s]
  std::array<double, 3> angular_velocity{};  ///< [rad/s]
  void checkpoint(Archive& archive) { archive(name, position, rest, rotation, velocity, angular_velocity); }
};
/// Into what a beam was divided: its nodes have the same stations in another scene if these are equal.
struct StoredBeam {
  std::string name;
  int elements = 0, order = 0;
  void checkpoint(Archive& archive) { archive(name, elements, order); }
};
struct StoredNumber {
  std::string name;
  double value = 0.0;
  void checkpoint(Archive& archive) { archive(name, value); }
};

struct StoredState {
  double time = 0.0;            ///< [s], or the load factor
  bool runs_over_load = false;  ///< the run is one of statics
  std::string frame;            ///< frame in which the analysis is described; empty: the inertial frame
  std::vector<StoredPart> parts;
  std::vector<StoredBeam> beams;
  std::vector<StoredNumber> turns;    ///< angles of joints, with their whole turns [rad]
  std::vector<StoredNumber> signals;  ///< values of states and inputs
  void checkpoint(Archive& archive) { archive(time, runs_over_load, frame, parts, beams, turns, signals); }
};

}  // namespace bough::records
