#pragma once
/// The groups on which elements move. Each is a type with the same names, so that kernels are written once.
#include <variant>

#include "bough/motion/group_se2.hpp"
#include "bough/motion/group_se3.hpp"
#include "bough/motion/group_translations.hpp"

namespace bough::motion {

template <class... G>
struct GroupList {
  /// One of T<G>, for the groups G of the list.
  template <template <class> class T>
  using OneOf = std::variant<T<G>...>;
};

/// All groups, the list and what instantiates templates for each. A scene moves on one of them: on SE(3), unless the
/// plan finds that one of the others suffices.
using Groups = GroupList<Se3, Se2, Translations<3>, Translations<1>>;
#define BOUGH_FOR_EVERY_GROUP(DO) \
  DO(bough::motion::Se3)          \
  DO(bough::motion::Se2)          \
  DO(bough::motion::Translations<3>) DO(bough::motion::Translations<1>)

}  // namespace bough::motion
