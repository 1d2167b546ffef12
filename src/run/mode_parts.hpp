#pragma once
/// What moves and what is strained in modes, by parts of the scene and in words.
#include <array>
#include <string>
#include <utility>
#include <vector>

#include "bough/step/modes.hpp"

namespace bough::run {

/// Shares of an energy by parts, the largest first [-].
using Shares = std::vector<std::pair<std::string, double>>;

/// Looks at modes about a state; keeps references to both.
class ModeParts {
 public:
  ModeParts(const step::Linearisation& linear, const step::State& state);

  /// By direction x, y, z and about axes through the centre of mass of what moves, in the axes of the ground: of a mode
  /// of unit modal mass x^H M x, |x^H M r|, with r the rigid motion of unit size. The square is the effective modal
  /// mass or inertia.
  std::array<double, 6> participation(const step::Mode& mode) const;
  /// Mass and moments of inertia of what moves [kg, kg m^2]: sums of all effective ones where nothing is driven.
  const std::array<double, 6>& moving_mass() const { return moving_mass_; }

  /// Scales a mode to unit modal mass; a modal mass of zero is left. Rotates the phase of a complex one so that the
  /// entry that moves most is real and positive.
  void normalise(step::Mode& mode) const;
  Shares kinetic_shares(const step::Mode& mode) const { return shares(mode, step::Linearisation::Part::mass); }
  Shares strain_shares(const step::Mode& mode) const { return shares(mode, step::Linearisation::Part::stiffness); }
  /// "'blade' bends along (0, 0, 1)"
  std::string describe(const step::Mode& mode) const;

  /// Replaces rigid modes by rigid motions of the whole where these are among them, and by what is left of the others.
  /// Returns the name of each: "translation x", "rotation of joint 'hinge'".
  std::vector<std::string> name_rigid(std::vector<step::Mode>& rigid) const;

 private:
  using Vector = std::vector<double>;
  using Part = step::Linearisation::Part;
  Shares shares(const step::Mode& mode, Part part) const;
  double form(Part part, const Vector& x, const Vector& y) const;
  Vector rigid_motion(int direction, const motion::Vec3<double>& about) const;
  motion::Vec6<double> in_ground(const Vector& x, int node) const;
  std::string name_of_joint_motion(const Vector& x) const;
  bool deforms(const std::string& name, const Vector& x) const;
  std::string verb_of_beam(const std::string& name, const Vector& x) const;

  const step::Linearisation& linear_;
  const plan::Plan& plan_;
  const step::State& state_;
  const std::vector<elements::NodeMotion> nodes_;
  std::array<Vector, 6> rigid_, mass_times_rigid_;
  std::array<double, 6> moving_mass_{};
};

/// "'tower' 62 %, 'blade' 30 %": the three largest, of at least 1 %.
std::string text_of(const Shares& shares);

}  // namespace bough::run
