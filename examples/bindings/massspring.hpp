/// @file massspring.hpp
/// The library for C++17: objects that free themselves, and exceptions that carry the error message. Part of an
/// example, to copy and to extend; it is not installed, and the ABI is that of massspring.h.
///
/// SPDX-License-Identifier: MIT
#ifndef MASSSPRING_HPP
#define MASSSPRING_HPP

#include <cstdint>
#include <memory>
#include <new>
#include <stdexcept>
#include <string>
#include <vector>

#include <massspring/massspring.h>

namespace massspring {

struct error : std::runtime_error {
    error(mspring_result code, const char *message)
        : std::runtime_error(std::string(mspring_result_string(code)) + ": " + message), code(code) {}
    mspring_result code;
};

/// A definition with its defaults, by the init function of its type.
template <typename Def, mspring_result (*init)(Def *, size_t)> struct with_defaults : Def {
    with_defaults() : Def() {
        if (mspring_result result = init(this, sizeof(Def)); result != MSPRING_OK)
            throw error(result, "the library is older than its header");
    }
};
using material = with_defaults<mspring_material, mspring_material_init>;
using lattice_def = with_defaults<mspring_lattice_def, mspring_lattice_def_init>;

class builder {
public:
    builder() {
        mspring_builder *made = nullptr;
        if (mspring_result result = mspring_builder_create(nullptr, &made); result != MSPRING_OK)
            throw error(result, "builder");
        handle.reset(made);
    }
    /// Particle ids of the cells, row by row from the top.
    std::vector<mspring_id> add_lattice(const mspring_lattice_def &def) {
        std::vector<mspring_id> ids(size_t(def.width) * def.height);
        check(mspring_builder_add_lattice(get(), &def, ids.data()));
        return ids;
    }
    /// Read an archive: a network made of this builder continues where the archived one was.
    void read(const std::vector<unsigned char> &archive) {
        check(mspring_builder_read(get(), archive.data(), archive.size(), nullptr));
    }
    void check(mspring_result result) const {
        if (result != MSPRING_OK)
            throw error(result, mspring_builder_error(get()));
    }
    mspring_builder *get() const { return handle.get(); }

private:
    struct destroy {
        void operator()(mspring_builder *made) const { mspring_builder_destroy(made); }
    };
    std::unique_ptr<mspring_builder, destroy> handle;
};

class network {
public:
    explicit network(const builder &from, const mspring_network_def *def = nullptr) {
        mspring_network *made = nullptr;
        from.check(mspring_network_create(from.get(), def, &made));
        handle.reset(made);
    }
    mspring_settings settings() const {
        mspring_settings now{};
        now.struct_size = sizeof now;
        check(mspring_network_get_settings(get(), &now));
        return now;
    }
    void set_settings(const mspring_settings &settings) {
        check(mspring_network_set_settings(get(), &settings));
    }
    void step(double dt) { check(mspring_network_step(get(), dt)); }

    struct point {
        double x, y;
    };
    point position(mspring_id particle) const {
        point p{};
        check(mspring_network_get_positions(get(), particle, 1, &p.x, &p.y, 1));
        return p;
    }
    /// Measure the particles first ... first + count - 1 as one body.
    mspring_body body(mspring_id first, std::uint32_t count) const {
        mspring_body measured{};
        measured.struct_size = sizeof measured;
        check(mspring_network_get_body(get(), nullptr, first, count, &measured));
        return measured;
    }
    void apply_torque(mspring_id first, std::uint32_t count, float torque) {
        check(mspring_network_apply_torque(get(), nullptr, first, count, torque));
    }
    std::uint64_t hash() const {
        std::uint64_t value = 0;
        check(mspring_network_state_hash(get(), &value));
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
        check(mspring_network_write(get(), append, &bytes));
        return bytes;
    }
    void check(mspring_result result) const {
        if (result != MSPRING_OK)
            throw error(result, mspring_network_error(get()));
    }
    mspring_network *get() const { return handle.get(); }

private:
    struct destroy {
        void operator()(mspring_network *made) const { mspring_network_destroy(made); }
    };
    std::unique_ptr<mspring_network, destroy> handle;
};

} // namespace massspring

#endif
