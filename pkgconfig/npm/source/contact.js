// What a network meets: the floor, other bodies, colliders and grips.
import { number, whole } from './core.js';
import { State } from './state.js';
import { STRUCTS } from './tables.js';

export class Contact extends State {
  // A call that gives an id.
  #id(body) {
    const { core } = this;
    this.run((_, exports, pointer) => body(exports, pointer, core.word));
    return core.data.getUint32(core.word, true);
  }

  setFloor(options) {
    this.run((core, exports, pointer) =>
      exports.mspring_network_set_floor(pointer, options === null ? 0 : core.write('floor_def', options)));
  }

  floorImpulses({ into, ...where } = {}) {
    const { first, count } = this.span(where, this.particleCount);
    return this.read('f32', 2 * count, into, [Float32Array], (found) =>
      this.core.exports.mspring_network_get_floor_impulses(this.pointer, first, count, found, found + 4, 2));
  }

  setContact(options) {
    this.run((core, exports, pointer) =>
      exports.mspring_network_set_contact(pointer, options === null ? 0 : core.write('contact_def', options)));
  }

  getContact() {
    const contact = this.report('contact_def', (exports, pointer, found) =>
      exports.mspring_network_get_contact(pointer, found));
    return contact.capacity ? contact : null;
  }

  setContactGroups(groups, masks, where) {
    const { first, count } = this.span(where, this.particleCount);
    this.check(this.core.exports.mspring_network_set_contact_groups(this.pointer, first, count, whole(groups, 'groups'),
      whole(masks, 'masks')));
  }

  setContactSurface({ friction = -1, restitution = -1 }, where) {
    const { first, count } = this.span(where, this.particleCount);
    this.check(this.core.exports.mspring_network_set_contact_surface(this.pointer, first, count, friction, restitution));
  }

  contactInfo() {
    return this.report('contact_info', (exports, pointer, found) =>
      exports.mspring_network_get_contact_info(pointer, found));
  }

  reserveContactEvents(capacity) {
    this.check(this.core.exports.mspring_network_reserve_contact_events(this.pointer, whole(capacity, 'capacity')));
  }

  readContactEvents(most = 256) {
    const { core } = this, { size } = STRUCTS.contact_event;
    return core.call(() => {
      const found = core.blank('contact_event', whole(most, 'most'));
      this.check(core.exports.mspring_network_read_contact_events(this.pointer, found, most, core.word, core.word + 8));
      const count = core.data.getUint32(core.word, true), lost = Number(core.data.getBigUint64(core.word + 8, true));
      return { events: Array.from({ length: count }, (_, i) => core.read('contact_event', found + i * size)), lost };
    });
  }

  /* ------------------------------------------------------------------------------------------------- colliders */

  addCollider(options) {
    return this.#id((exports, pointer, id) =>
      exports.mspring_network_add_collider(pointer, this.core.write('collider_def', options), id));
  }

  removeCollider(collider) {
    this.check(this.core.exports.mspring_network_remove_collider(this.pointer, whole(collider, 'collider')));
  }

  moveCollider(collider, x, y, angle = 0) {
    this.check(this.core.exports.mspring_network_move_collider(this.pointer, whole(collider, 'collider'), number(x, 'x'),
      number(y, 'y'), number(angle, 'angle')));
  }

  placeCollider(collider, x, y, angle = 0) {
    this.check(this.core.exports.mspring_network_place_collider(this.pointer, whole(collider, 'collider'), number(x, 'x'),
      number(y, 'y'), number(angle, 'angle')));
  }

  getCollider(collider) {
    return this.report('collider_def', (exports, pointer, found) =>
      exports.mspring_network_get_collider(pointer, whole(collider, 'collider'), found));
  }

  colliderImpulse(collider) {
    const [x, y, angular] = this.numbers('f64', 3, (exports, pointer, ...found) =>
      exports.mspring_network_get_collider_impulse(pointer, whole(collider, 'collider'), ...found));
    return { x, y, angular };
  }

  /* ----------------------------------------------------------------------------------------------------- grips */

  addGrip(options) {
    return this.#id((exports, pointer, id) =>
      exports.mspring_network_add_grip(pointer, this.core.write('grip_def', options), id));
  }

  removeGrip(grip) {
    this.check(this.core.exports.mspring_network_remove_grip(this.pointer, whole(grip, 'grip')));
  }

  setGrip(grip, options) {
    this.run((core, exports, pointer) =>
      exports.mspring_network_set_grip(pointer, whole(grip, 'grip'), core.write('grip_def', options)));
  }

  moveGrip(grip, x, y) {
    this.check(this.core.exports.mspring_network_move_grip(this.pointer, whole(grip, 'grip'), number(x, 'x'), number(y, 'y')));
  }

  getGrip(grip) {
    return this.report('grip_def', (exports, pointer, found) =>
      exports.mspring_network_get_grip(pointer, whole(grip, 'grip'), found));
  }

  gripImpulse(grip) {
    const [x, y] = this.numbers('f64', 2, (exports, pointer, ...found) =>
      exports.mspring_network_get_grip_impulse(pointer, whole(grip, 'grip'), ...found));
    return { x, y };
  }
}
