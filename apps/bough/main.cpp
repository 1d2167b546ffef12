#include <exception>
#include <iostream>
#include <new>

#include "arguments.hpp"

/// Whatever was not foreseen still ends in a sentence and a status.
int main(int count, char** values) {
  try {
    return bough::app::dispatch(count, values);
  } catch (const std::bad_alloc&) {
    std::cerr << "bough: out of memory\n";
  } catch (const std::exception& error) {
    std::cerr << "bough: " << error.what() << "\n";
  }
  return bough::app::exit_failed;
}
