#pragma once
/// Energies and momentum of the whole structure, elements of one kind eight at a time.
#include <tuple>
#include <vector>

#include "bough/elements/energies.hpp"
#include "bough/plan/stores.hpp"
#include "bough/step/system.hpp"

namespace bough::results {

/// Energies and momentum with respect to the inertial frame, in its axes.
struct Energies {
  double kinetic = 0.0;                                          ///< [J]
  double strain = 0.0;                                           ///< [J]
  double potential = 0.0;                                        ///< of gravity, about the inertial origin [J]
  motion::Vec6<double> momentum = motion::Vec6<double>::zero();  ///< (linear; angular about the inertial origin)
  double total() const { return kinetic + strain + potential; }
};

/// Evaluates the elements of a plan that store energy or carry momentum, which are sorted into lanes once. Sums go over
/// fixed chunks, so the bits do not depend on the number of threads. In scenes with moving frames, and where a law
/// changes their stiffness, elements are evaluated one by one.
class EnergyMeter {
 public:
  explicit EnergyMeter(const plan::Plan& plan);
  /// The laws of the system have to be evaluated at the state's time. No allocation after the first call.
  Energies eval(const step::System& system, const step::State& state);

 private:
  template <class E>
  struct Group {
    int first = 0, count = 0;  ///< elements of the plan's array, one after another
    int lanes = -1;            ///< in `lanes` below; -1: one by one
  };
  template <class E>
  struct Kind {
    std::vector<Group<E>> groups;
    std::vector<elements::LaneElement<E>> lanes;
  };
  using Kinds =
      std::tuple<Kind<elements::Beam<2>>, Kind<elements::Beam<3>>, Kind<elements::Beam<4>>, Kind<elements::RigidBody>,
                 Kind<elements::Joint>, Kind<elements::Spring>, Kind<elements::Bushing>>;
  template <class E>
  void sort(const plan::Plan& plan, Kind<E>& kind);
  template <class E>
  void add(const step::System& system, const step::State& state, const Kind<E>& kind, elements::Energies& sum);
  template <class E>
  void add_group(const std::vector<E>& array, const Kind<E>& kind, const Group<E>& group, const step::State& state,
                 const elements::Field& field, elements::Energies& sum) const;

  Kinds kinds_;
  double stored(const step::System& system, const step::State& state) const;

  std::vector<elements::Energies> parts_;  ///< of chunks
  std::vector<plan::EnergyStore> stores_;
};

}  // namespace bough::results
