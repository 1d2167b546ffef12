#pragma once
/// Counts the instructions that this thread executes in user space, if the system supports it.
#include <optional>

namespace bough::study {

class InstructionCounter {
 public:
  InstructionCounter();
  ~InstructionCounter();
  InstructionCounter(const InstructionCounter&) = delete;
  InstructionCounter& operator=(const InstructionCounter&) = delete;

  void start();
  std::optional<double> stop();  ///< since `start`; nothing where the system refuses (containers, virtual machines)

 private:
  int descriptor_ = -1;
};

}  // namespace bough::study
