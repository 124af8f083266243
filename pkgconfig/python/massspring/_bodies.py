"""What bodies meet: the floor, each other, colliders, and grips.

SPDX-License-Identifier: MIT
"""
from __future__ import annotations

from typing import TYPE_CHECKING, Any, Optional, Tuple, Union

import numpy as np

from . import _header
from ._calls import NetworkCalls, Span
from ._core import Ids, bad_argument, dtype_of, ffi, filled, lib, numbers, pointer, with_keywords

if TYPE_CHECKING:
    from typing_extensions import Unpack

    from ._header import (ColliderDef, ColliderKeywords, ColliderKind, ContactDef, ContactInfo, ContactKeywords,
                          FloorDef, FloorKeywords, GripDef, GripKeywords)

CONTACT_EVENT = dtype_of("mspring_contact_event")


class BodyCalls(NetworkCalls):
    """Floor, contact, colliders and grips of a Network."""

    # ---------------------------------------------------------------------------------------------------- floor

    @with_keywords("mspring_floor_def")
    def set_floor(self, planes: Any = None, heights: Any = None, plane_frictions: Any = None,
                  plane_restitutions: Any = None, height_frictions: Any = None, height_restitutions: Any = None,
                  **fields: Unpack[FloorKeywords]) -> None:
        """Set the floor, instead of the one that the network has: half-planes, a field of heights, or both.

        planes   (n, 4): x, y of a point on the border (m), x, y of a normal that points to where particles may be
        heights  (n,), m above heights_y, spacing apart from heights_x on
        plane_frictions, plane_restitutions     (n,), of each plane
        height_frictions, height_restitutions   (n - 1,), of each part between heights
        """
        def_ = filled("mspring_floor_def", dict(fields), ("plane_count", "height_count"))
        kept = []

        def attach(name: str, value: Any, dtype: str, ctype: str, shape: Tuple[Optional[int], ...]) -> int:
            if value is None:
                return 0
            kept.append(numbers(name, value, dtype, shape))
            setattr(def_, name, pointer(ctype, kept[-1]))
            return len(kept[-1])

        planes_given = attach("planes", planes, "f8", "double", (None, 4))
        heights_given = attach("heights", heights, "f4", "float", (None,))
        def_.plane_count, def_.height_count = planes_given, heights_given
        attach("plane_frictions", plane_frictions, "f4", "float", (planes_given,))
        attach("plane_restitutions", plane_restitutions, "f4", "float", (planes_given,))
        attach("height_frictions", height_frictions, "f4", "float", (max(heights_given - 1, 0),))
        attach("height_restitutions", height_restitutions, "f4", "float", (max(heights_given - 1, 0),))
        self._change(lib.mspring_network_set_floor, def_)

    def clear_floor(self) -> None:
        """Remove the floor."""
        self._change(lib.mspring_network_set_floor, ffi.NULL)

    @property
    def floor(self) -> FloorDef:
        """The floor's numbers. Without a floor both counts are 0."""
        return self._report(_header.FloorDef, "mspring_floor_def", lib.mspring_network_get_floor)

    @property
    def floor_impulses(self) -> np.ndarray:
        """Impulses that the floor gave to particles in the last step, N s: float32 (n, 2). Over dt they are forces."""
        out = np.empty((self.particle_count, 2), np.float32)
        self._read(lib.mspring_network_get_floor_impulses, 0, len(out), pointer("float", out), pointer("float", out, 1),
                   2)
        return out

    # -------------------------------------------------------------------------------------------------- contact

    @with_keywords("mspring_contact_def")
    def set_contact(self, **fields: Unpack[ContactKeywords]) -> None:
        """Let the bodies of the network collide, or change how they do. Set it before the network deforms.

        If there is contact already, groups, colliders and events stay.
        """
        self._change(lib.mspring_network_set_contact, filled("mspring_contact_def", dict(fields)))

    def clear_contact(self) -> None:
        """End contact. Groups, colliders and events are forgotten."""
        self._change(lib.mspring_network_set_contact, ffi.NULL)

    @property
    def contact(self) -> ContactDef:
        """The contact. Without it capacity is 0."""
        return self._report(_header.ContactDef, "mspring_contact_def", lib.mspring_network_get_contact)

    @property
    def contact_info(self) -> ContactInfo:
        """What touched in the last step."""
        return self._report(_header.ContactInfo, "mspring_contact_info", lib.mspring_network_get_contact_info)

    def reserve_contact_events(self, capacity: int) -> None:
        """Reserve room for contact events, which are recorded from then on. It needs set_contact()."""
        self._change(lib.mspring_network_reserve_contact_events, capacity)
        self._contact_capacity = capacity

    _contact_capacity = 0
    contact_events_lost = 0  # events that had no room, as of the last read_contact_events()

    def read_contact_events(self) -> np.ndarray:
        """Read and remove all contact events that wait, oldest first, with the fields of mspring_contact_event."""
        events = np.zeros(self._contact_capacity, CONTACT_EVENT)
        events["struct_size"] = CONTACT_EVENT.itemsize
        count, lost = ffi.new("uint32_t *"), ffi.new("uint64_t *")
        self._change(lib.mspring_network_read_contact_events, pointer("mspring_contact_event", events), len(events),
                     count, lost)
        self.contact_events_lost = lost[0]
        if 0 < count[0] == len(events):  # there may be more, of a network from an archive
            return np.concatenate((events, self.read_contact_events()))
        return events[:count[0]].copy()

    def set_contact_groups(self, groups: int, masks: int, ids: Ids = None) -> None:
        """Set which particles may touch: each one's group must have a bit of the other's mask. ids is a range."""
        span = Span(ids, self.particle_count)
        span.must_be_range()
        for name, value in (("groups", groups), ("masks", masks)):
            if not 0 <= value <= 0xFFFFFFFF:
                raise bad_argument(f"{name} is {value}: it must have 32 bits")
        self._change(lib.mspring_network_set_contact_groups, span.first, span.count, groups, masks)

    def set_contact_surface(self, friction: Optional[float] = None, restitution: Optional[float] = None,
                            ids: Ids = None) -> None:
        """Set friction and restitution of particles; None: the contact's. ids is a range.

        Where two touch, friction is the square root of the product, restitution the larger one.
        """
        span = Span(ids, self.particle_count)
        span.must_be_range()
        self._change(lib.mspring_network_set_contact_surface, span.first, span.count,
                     -1 if friction is None else friction, -1 if restitution is None else restitution)

    # ------------------------------------------------------------------------------------------------ colliders

    @with_keywords("mspring_collider_def")
    def add_collider(self, kind: Union[ColliderKind, str] = "chain", points: Any = None,
                     **fields: Unpack[ColliderKeywords]) -> int:
        """Add a shape that you own and move, and that bodies collide with. Returns its id. It needs set_contact().

        kind    "chain", "box" or "circle"
        points  (n, 2), of a chain, m, relative to its position
        """
        def_ = filled("mspring_collider_def", {"kind": kind, **fields}, ("point_count",))
        if points is not None:
            array = numbers("points", points, "f8", (None, 2))
            def_.points, def_.point_count = pointer("double", array), len(array)
        return self._made(lib.mspring_network_add_collider, def_)

    def remove_collider(self, collider: int) -> None:
        """Remove a collider."""
        self._change(lib.mspring_network_remove_collider, collider)

    def move_collider(self, collider: int, x: float, y: float, angle: float = 0.0) -> None:
        """Set where a collider is to be at the end of the next step, m and rad. It pushes bodies in its way."""
        self._change(lib.mspring_network_move_collider, collider, x, y, angle)

    def place_collider(self, collider: int, x: float, y: float, angle: float = 0.0) -> None:
        """Put a collider somewhere else at once, m and rad. It touches nothing on its way."""
        self._change(lib.mspring_network_place_collider, collider, x, y, angle)

    def get_collider(self, collider: int) -> ColliderDef:
        """Read a collider: shape, position (m) and angle (rad) now."""
        return self._report(_header.ColliderDef, "mspring_collider_def", lib.mspring_network_get_collider, collider)

    def get_collider_impulse(self, collider: int) -> Tuple[float, float, float]:
        """Read the impulses that bodies gave to a collider in the last step: x, y (N s), angular (N m s)."""
        made = ffi.new("double[3]")
        self._read(lib.mspring_network_get_collider_impulse, collider, made, made + 1, made + 2)
        return made[0], made[1], made[2]

    # ---------------------------------------------------------------------------------------------------- grips

    @with_keywords("mspring_grip_def")
    def add_grip(self, particle: int, **fields: Unpack[GripKeywords]) -> int:
        """Hold a particle softly, as a mouse would. Returns the grip's id."""
        return self._made(lib.mspring_network_add_grip, filled("mspring_grip_def", {"particle": particle, **fields}))

    def set_grip(self, grip: int, **fields: Unpack[GripKeywords]) -> None:
        """Change some fields of a grip."""
        self._modify_one("mspring_grip_def", lib.mspring_network_get_grip, lib.mspring_network_set_grip, grip, fields)

    def remove_grip(self, grip: int) -> None:
        """Let go."""
        self._change(lib.mspring_network_remove_grip, grip)

    def move_grip(self, grip: int, x: float, y: float) -> None:
        """Move the target of a grip to the world position (x, y), m. It goes there in a straight line in one step."""
        self._change(lib.mspring_network_move_grip, grip, x, y)

    def get_grip(self, grip: int) -> GripDef:
        """Read a grip."""
        return self._report(_header.GripDef, "mspring_grip_def", lib.mspring_network_get_grip, grip)

    def get_grip_impulse(self, grip: int) -> Tuple[float, float]:
        """Read the impulse that a grip gave its particle in the last step, N s."""
        made = ffi.new("double[2]")
        self._read(lib.mspring_network_get_grip_impulse, grip, made, made + 1)
        return made[0], made[1]
