// Laws beyond the linear spring: springs that yielded, areas and angle springs.
import { array, fail, whole } from './core.js';
import { Contact } from './contact.js';

export class Laws extends Contact {
  // A call that writes numbers into words: what they are.
  #words(count, body) {
    const { core } = this;
    this.run((_, exports, pointer) => body(exports, pointer, core.word));
    return Array.from({ length: count }, (_, i) => core.data.getUint32(core.word + 4 * i, true));
  }

  // Ids and two numbers of each: of areas, of angles.
  #all(names, body) {
    const { core } = this, { exports } = core;
    return core.call(() => {
      this.check(body(exports, this.pointer, 0, 0, 0, 0, core.word));
      const count = core.data.getUint32(core.word, true), ids = core.take(4 * count + 4);
      const first = core.take(8 * count + 8), second = core.take(8 * count + 8);
      this.check(body(exports, this.pointer, ids, first, second, count, core.word));
      return { ids: core.copyOut('u32', ids, count), [names[0]]: core.copyOut('f64', first, count),
        [names[1]]: core.copyOut('f64', second, count) };
    });
  }

  plasticity() {
    return this.report('plasticity', (exports, pointer, found) =>
      exports.mspring_network_get_plasticity(pointer, found));
  }

  /* ----------------------------------------------------------------------------------------------------- areas */

  addArea(particles, options) {
    const list = array('u32', particles, 'particles');
    return this.#words(1, (exports, pointer, word) => exports.mspring_network_add_area(pointer,
      this.core.write('area_def', options), this.core.copyIn('u32', list), list.length, word))[0];
  }

  addCellAreas(options) {
    const [first, count] = this.#words(2, (exports, pointer, word) =>
      exports.mspring_network_add_cell_areas(pointer, this.core.write('area_def', options), word, word + 4));
    return { first, count };
  }

  removeArea(area) {
    this.check(this.core.exports.mspring_network_remove_area(this.pointer, whole(area, 'area')));
  }

  setArea(area, options) {
    this.run((core, exports, pointer) =>
      exports.mspring_network_set_area(pointer, whole(area, 'area'), core.write('area_def', options)));
  }

  getArea(area) {
    return this.report('area_def', (exports, pointer, found) =>
      exports.mspring_network_get_area(pointer, whole(area, 'area'), found));
  }

  areaInfo(area) {
    return this.report('area_info', (exports, pointer, found) =>
      exports.mspring_network_get_area_info(pointer, whole(area, 'area'), found));
  }

  areas() {
    return this.#all(['areas', 'pressures'], (exports, ...rest) => exports.mspring_network_get_areas(...rest));
  }

  /* ---------------------------------------------------------------------------------------------------- angles */

  addAngles(particles, options) {
    const list = array('u32', particles, 'particles');
    if (list.length % 3) fail(`particles has ${list.length} ids, which is no multiple of 3`);
    const first = this.#words(1, (exports, pointer, word) => exports.mspring_network_add_angles(pointer,
      this.core.write('angle_def', options), this.core.copyIn('u32', list), list.length / 3, word))[0];
    return { first, count: list.length / 3 };
  }

  removeAngle(angle) {
    this.check(this.core.exports.mspring_network_remove_angle(this.pointer, whole(angle, 'angle')));
  }

  setAngle(angle, options) {
    this.run((core, exports, pointer) =>
      exports.mspring_network_set_angle(pointer, whole(angle, 'angle'), core.write('angle_def', options)));
  }

  setRestAngles(first, restAngles) {
    const list = array('f64', restAngles, 'restAngles');
    this.run((core, exports, pointer) => exports.mspring_network_set_rest_angles(pointer, whole(first, 'first'), list.length,
      core.copyIn('f64', list), 1));
  }

  getAngle(angle) {
    return this.report('angle_def', (exports, pointer, found) =>
      exports.mspring_network_get_angle(pointer, whole(angle, 'angle'), found));
  }

  angleInfo(angle) {
    return this.report('angle_info', (exports, pointer, found) =>
      exports.mspring_network_get_angle_info(pointer, whole(angle, 'angle'), found));
  }

  angles() {
    return this.#all(['angles', 'torques'], (exports, ...rest) => exports.mspring_network_get_angles(...rest));
  }
}
