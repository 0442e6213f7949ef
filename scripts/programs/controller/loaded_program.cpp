#include "scripts/programs/controller/loaded_program.hpp"

#include <utility>

namespace cellmirror::program {

LoadedProgram::LoadedProgram(std::string name_as_loaded, std::shared_ptr<const Program> what)
    : name(std::move(name_as_loaded)), program(std::move(what)) {
  for (const Statement& statement : program->statements) {
    const auto* semaphore = std::get_if<SemaphoreStatement>(&statement);
    if (semaphore == nullptr) continue;
    const std::string& of = program->texts[semaphore->name];
    if (!semaphore->acquire) released.insert(of);
    used.insert(of);
  }
  for (const SemaphoreDeclaration& declaration : program->semaphores) used.insert(declaration.name);
}

}  // namespace cellmirror::program
