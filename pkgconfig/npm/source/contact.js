// What a network meets: the floor, other bodies, colliders and grips.
import { number, whole } from './core.js';
import { State } from './state.js';

export class Contact extends State {
  #options(struct, options) {
    return options === null ? 0 : this.core.write(struct, options);
  }

  get floor() {
    const floor = this.report('get_floor', 'floor_def');
    return floor.planes || floor.heights ? floor : null;
  }

  setFloor(options) {
    this.core.call(() => this.call('set_floor', this.#options('floor_def', options)));
  }

  get contact() {
    const contact = this.report('get_contact', 'contact_def');
    return contact.capacity ? contact : null;
  }

  setContact(options) {
    this.core.call(() => this.call('set_contact', this.#options('contact_def', options)));
  }

  get contactInfo() {
    return this.report('get_contact_info', 'contact_info');
  }

  readContactEvents(most = 256) {
    return this.events('contact_event', most, (...given) => this.call('read_contact_events', ...given));
  }

  // Those that wait. body(events, capacity, count, lost) is the call.
  events(struct, most, body) {
    const { core } = this;
    return core.call(() => {
      const found = core.begin(struct, whole(most, 'most'));
      body(found, most, core.word, core.word + 8);
      const count = core.data.getUint32(core.word, true), lost = Number(core.data.getBigUint64(core.word + 8, true));
      return { events: core.readAll(struct, found, count), lost };
    });
  }

  /* ------------------------------------------------------------------------------------------------- colliders */

  addCollider(options) {
    return this.core.call(() => this.words('add_collider', this.core.write('collider_def', options))[0]);
  }

  removeCollider(collider) {
    this.call('remove_collider', whole(collider, 'collider'));
  }

  moveCollider(collider, x, y, angle = 0) {
    this.call('move_collider', whole(collider, 'collider'), number(x, 'x'), number(y, 'y'), number(angle, 'angle'));
  }

  placeCollider(collider, x, y, angle = 0) {
    this.call('place_collider', whole(collider, 'collider'), number(x, 'x'), number(y, 'y'), number(angle, 'angle'));
  }

  collider(collider) {
    return this.report('get_collider', 'collider_def', whole(collider, 'collider'));
  }

  colliderImpulse(collider) {
    return this.numbers('get_collider_impulse', 'f64', ['x', 'y', 'angular'], whole(collider, 'collider'));
  }

  /* ----------------------------------------------------------------------------------------------------- grips */

  addGrip(options) {
    return this.core.call(() => this.words('add_grip', this.core.write('grip_def', options))[0]);
  }

  removeGrip(grip) {
    this.call('remove_grip', whole(grip, 'grip'));
  }

  setGrip(grip, options) {
    const { core } = this;
    core.call(() => {
      const found = core.begin('grip_def');
      this.call('get_grip', whole(grip, 'grip'), found);
      core.overlay('grip_def', found, options);
      this.call('set_grip', grip, found);
    });
  }

  moveGrip(grip, x, y) {
    this.call('move_grip', whole(grip, 'grip'), number(x, 'x'), number(y, 'y'));
  }

  grip(grip) {
    return this.report('get_grip', 'grip_def', whole(grip, 'grip'));
  }

  gripImpulse(grip) {
    return this.numbers('get_grip_impulse', 'f64', ['x', 'y'], whole(grip, 'grip'));
  }
}
