/// @file massspring.hpp
/// The library for C++17: objects that free themselves, and exceptions that carry the error message. Part of an
/// example, to copy and to extend; it is not installed, and the ABI is that of massspring.h. Objects are
/// also the handles of the C functions: network.check(mspring_network_wake(network)).
///
/// SPDX-License-Identifier: MIT
#ifndef MASSSPRING_HPP
#define MASSSPRING_HPP

#include <cstdint>
#include <memory>
#include <new>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

#include <massspring/massspring.h>

namespace massspring {

struct error : std::runtime_error {
    error(mspring_result result, const char *message)
        : std::runtime_error(std::string(mspring_result_string(result)) + ": " + message), code(result) {}
    mspring_result code;
};

/// Which things a call is about: all, one, a range, or a list, which is not copied.
struct things {
    const mspring_id *ids = nullptr;
    mspring_id first = 0;
    std::uint32_t count = MSPRING_ALL;
    things() = default;
    things(mspring_id from, std::uint32_t size = 1) : first(from), count(size) {}
    things(const std::vector<mspring_id> &list) : ids(list.data()), count(std::uint32_t(list.size())) {}
};

struct point {
    double x, y;
};

/// The type of a property's values.
template <mspring_property property>
using value_of = std::conditional_t<(property & 0x80) != 0, std::uint32_t, float>;

template <auto destroy> struct deleter {
    template <typename Object> void operator()(Object *made) const { destroy(made); }
};

class builder {
public:
    builder() {
        mspring_builder *made = nullptr;
        if (mspring_result result = mspring_builder_create(nullptr, &made); result != MSPRING_OK)
            throw error(result, "builder");
        handle.reset(made);
    }
    mspring_id add(const mspring_particle_def &def) { return one(mspring_builder_add_particles(*this, &def, 1, &id)); }
    mspring_id add(const mspring_spring_def &def) { return one(mspring_builder_add_springs(*this, &def, 1, &id)); }
    mspring_id add(const mspring_mesh_def &def) { return one(mspring_builder_add_mesh(*this, &def, &id, nullptr)); }
    mspring_id add(const mspring_disc_def &def) { return one(mspring_builder_add_disc(*this, &def, &id, nullptr)); }
    /// Particle ids along the rope, both ends included.
    std::vector<mspring_id> add(const mspring_rope_def &def) {
        std::vector<mspring_id> ids(std::size_t(def.segment_count) + 1);
        check(mspring_builder_add_rope(*this, &def, ids.data(), nullptr));
        return ids;
    }
    /// Particle ids of the cells, row by row from the top.
    std::vector<mspring_id> add(const mspring_lattice_def &def) {
        std::vector<mspring_id> ids(std::size_t(def.width) * def.height);
        check(mspring_builder_add_lattice(*this, &def, ids.data()));
        return ids;
    }
    /// Read an archive: a network made of this builder continues where the archived one was.
    void read(const std::vector<unsigned char> &archive) {
        check(mspring_builder_read(*this, archive.data(), archive.size(), nullptr));
    }
    /// Throw the message of a call that failed. The builder forgets it, and goes on.
    void check(mspring_result result) const {
        if (result == MSPRING_OK)
            return;
        const error failure(result, mspring_builder_error(*this));
        mspring_builder_forget_error(*this);
        throw failure;
    }
    operator mspring_builder *() const noexcept { return handle.get(); }

private:
    mspring_id one(mspring_result result) const { return check(result), id; }
    std::unique_ptr<mspring_builder, deleter<mspring_builder_destroy>> handle;
    mspring_id id = MSPRING_NONE;
};

class network {
public:
    /// @param def  nullptr: the defaults, or those of the builder's archive
    explicit network(const builder &from, const mspring_network_def *def = nullptr) {
        mspring_network *made = nullptr;
        from.check(mspring_network_create(from, def, &made));
        handle.reset(made);
    }
    std::uint32_t count(mspring_kind kind) const { return mspring_network_count(*this, kind); }
    void step(double dt) { check(mspring_network_step(*this, dt)); }
    void set(const mspring_settings &settings) { check(mspring_network_set_settings(*this, &settings)); }
    void set(const mspring_floor_def &def) { check(mspring_network_set_floor(*this, &def)); }
    void set(const mspring_contact_def &def) { check(mspring_network_set_contact(*this, &def)); }
    mspring_id add(const mspring_collider_def &def) { return one(mspring_network_add_collider(*this, &def, &id)); }
    mspring_id add(const mspring_grip_def &def) { return one(mspring_network_add_grip(*this, &def, &id)); }
    mspring_id add(const mspring_area_def &def, const std::vector<mspring_id> &corners) {
        return one(mspring_network_add_area(*this, &def, corners.data(), std::uint32_t(corners.size()), &id));
    }
    /// Angles along a chain of particles, at least three. Returns the id of the first.
    mspring_id add(const mspring_angle_def &def, const std::vector<mspring_id> &chain) {
        return one(mspring_network_add_angles(*this, &def, chain.data(), std::uint32_t(chain.size() - 2), 1, &id));
    }

    /// A property: network.get<MSPRING_STRAIN>() of all springs.
    template <mspring_property property> std::vector<value_of<property>> get(const things &which = {}) const {
        std::vector<value_of<property>> values(range(which, property).count);
        get(property, which, values.data());
        return values;
    }
    /// By number, into memory of the caller's.
    void get(mspring_property property, things which, float *values, std::uint32_t stride = 1) const {
        call(mspring_network_get, property, which, values, stride);
    }
    void get(mspring_property property, things which, std::uint32_t *values, std::uint32_t stride = 1) const {
        call(mspring_network_get_integers, property, which, values, stride);
    }
    /// The same value for all.
    template <mspring_property property> void set(const things &which, value_of<property> value) {
        set(property, which, &value, 0);
    }
    void set(mspring_property property, things which, const float *values, std::uint32_t stride = 1) {
        call(mspring_network_set, property, which, values, stride);
    }
    void set(mspring_property property, things which, const std::uint32_t *values, std::uint32_t stride = 1) {
        call(mspring_network_set_integers, property, which, values, stride);
    }

    std::vector<point> positions(const things &which = {}) const {
        const things of = range(which, MSPRING_X);
        std::vector<point> at(of.count + 1u); // one more, so that there is a first
        check(mspring_network_get_positions(*this, of.ids, of.first, of.count, &at[0].x, &at[0].y, 2));
        at.pop_back();
        return at;
    }
    /// Measure particles as one body.
    mspring_body body(const things &which = {}) const {
        auto measured = mspring_body_default();
        check(mspring_network_get_body(*this, which.ids, which.first, which.count, &measured));
        return measured;
    }
    mspring_settings settings() const {
        auto now = mspring_settings_default();
        check(mspring_network_get_settings(*this, &now));
        return now;
    }
    std::uint64_t hash() const {
        std::uint64_t value = 0;
        check(mspring_network_get_state_hash(*this, &value));
        return value;
    }
    /// Return an archive of the network, for a file that this and all later versions read.
    std::vector<unsigned char> archive() const {
        std::vector<unsigned char> bytes;
        const auto append = [](const void *piece, size_t size, void *user) {
            const auto *from = static_cast<const unsigned char *>(piece);
            auto &to = *static_cast<std::vector<unsigned char> *>(user);
            try {
                to.insert(to.end(), from, from + size);
            } catch (const std::bad_alloc &) {
                return MSPRING_ERROR_MEMORY;
            }
            return MSPRING_OK;
        };
        check(mspring_network_write(*this, append, &bytes));
        return bytes;
    }
    void check(mspring_result result) const {
        if (result != MSPRING_OK)
            throw error(result, mspring_network_error(*this));
    }
    operator mspring_network *() const noexcept { return handle.get(); }

private:
    mspring_id one(mspring_result result) const { return check(result), id; }
    // With the count of all things of the property's kind.
    things range(things which, mspring_property property) const {
        const std::uint32_t size = count(mspring_kind(property >> 8));
        if (which.count == MSPRING_ALL)
            which.count = which.first < size ? size - which.first : 0;
        return which;
    }
    template <typename Function, typename Value>
    void call(Function function, mspring_property property, things which, Value *values, std::uint32_t stride) const {
        which = range(which, property);
        check(function(*this, property, which.ids, which.first, which.count, values, stride));
    }
    std::unique_ptr<mspring_network, deleter<mspring_network_destroy>> handle;
    mspring_id id = MSPRING_NONE;
};

} // namespace massspring

#endif
