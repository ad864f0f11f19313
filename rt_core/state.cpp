#include "rt_core/state.h"

#include "rt_core/contact/contact.h"
#include "rt_core/hash.h"

namespace palpate {

namespace {

Arena lay_out(const Model& model, State& state) noexcept {
  Arena arena(&state, sizeof(State));
  state.place_pools(model, arena);
#define PALPATE_STATE_MEMBER(type, name, meaning) state.name.place_pools(model, arena);
  PALPATE_STATE_GROUPS(PALPATE_STATE_MEMBER)
#undef PALPATE_STATE_MEMBER
  state.bytes = arena.bytes();
  return arena;
}

Arena lay_out(const Model& model, Scratch& scratch) noexcept {
  Arena arena(&scratch, sizeof(Scratch));
  arena.place(scratch.contact, kMaxContacts);
  arena.place(scratch.foot, model.sizes.n_corner > 0 ? model.sizes.n_piece : 0);
  const ContactMethod& method = contact_method(method_of(model));
  if (method.scratch_bytes != nullptr) arena.place(scratch.own, static_cast<std::int64_t>(method.scratch_bytes(model)));
  scratch.bytes = arena.bytes();
  return arena;
}

struct HashVisitor {
  static constexpr bool kRealTime = true;
  Hasher hasher;

  void enter(const char*, std::int32_t) PALPATE_RT {}
  void leave() PALPATE_RT {}
  void skip(const char*, std::int32_t) PALPATE_RT { hasher.add(0u); }
  template <class T>
  void value(const char*, const T& x) PALPATE_RT {
    if constexpr (std::is_enum_v<T>) {
      hasher.add(static_cast<std::int32_t>(x));
    } else {
      hasher.add(x);
    }
  }
};

}  // namespace

std::size_t state_bytes(const Model& model) noexcept {
  State alone;
  return lay_out(model, alone).bytes();
}

std::size_t scratch_bytes(const Model& model) noexcept {
  Scratch alone;
  return lay_out(model, alone).bytes();
}

State& create_state(const Model& model, void* block) noexcept {
  State& state = *::new (static_cast<void*>(block)) State;
  lay_out(model, state);
  reset(state);
  return state;
}

Scratch& create_scratch(const Model& model, void* block) noexcept {
  Scratch& scratch = *::new (static_cast<void*>(block)) Scratch;
  lay_out(model, scratch);
  const ContactMethod& method = contact_method(method_of(model));
  if (method.create_scratch != nullptr) method.create_scratch(model, scratch.own.data());
  return scratch;
}

bool is_laid_out_for(const Model& model, const State& state) noexcept {
  State alone;
  lay_out(model, alone);
  bool alike = state.bytes == alone.bytes && state.is_laid_out_like(alone);
#define PALPATE_STATE_MEMBER(type, name, meaning) alike = alike && state.name.is_laid_out_like(alone.name);
  PALPATE_STATE_GROUPS(PALPATE_STATE_MEMBER)
#undef PALPATE_STATE_MEMBER
  return alike;
}

void copy_state(const State& from, State& to) PALPATE_RT {
  __builtin_memcpy(static_cast<void*>(&to), static_cast<const void*>(&from), from.bytes);
}

void reset(State& state) PALPATE_RT {
  state.reset();
#define PALPATE_STATE_MEMBER(type, name, meaning) state.name.reset();
  PALPATE_STATE_GROUPS(PALPATE_STATE_MEMBER)
#undef PALPATE_STATE_MEMBER
  state.high_water = {};
}

void forget_contact(State& state) PALPATE_RT {
  for (Real& k : state.contact_stiffness) k = 0;  // bound: 36
  state.point.fill({});
  state.region.fill({});
#define PALPATE_STATE_MEMBER(type, name, meaning) state.name.reset();
  PALPATE_METHOD_STATES(PALPATE_STATE_MEMBER)
#undef PALPATE_STATE_MEMBER
}

std::uint64_t hash_state(const State& state) PALPATE_RT {
  HashVisitor visitor;
  state.visit_all(visitor);
  return visitor.hasher.value;
}

}  // namespace palpate
