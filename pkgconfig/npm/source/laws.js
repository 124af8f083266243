// Elements: areas and angle springs. They are read and changed by properties.
import { array, fail, whole } from './core.js';
import { Contact } from './contact.js';

export class Laws extends Contact {
  addArea(particles, options) {
    const list = array('u32', particles, 'particles');
    return this.core.call(() => this.words('add_area', this.core.write('area_def', options), this.core.copyIn('u32', list),
      list.length)[0]);
  }

  addCellAreas(options) {
    const [first, count] = this.core.call(() => this.words('add_cell_areas', this.core.write('area_def', options)));
    return { first, count };
  }

  addAngles(particles, options, stride = 3) {
    const list = array('u32', particles, 'particles'), count = (list.length - 3) / whole(stride, 'stride') + 1;
    if (!(count >= 0 && Number.isInteger(count)))
      fail(`particles has ${list.length} ids, which is no multiple of 3, or of angles ${stride} apart`);
    const [first] = this.core.call(() => this.words('add_angles', this.core.write('angle_def', options),
      this.core.copyIn('u32', list), count, stride));
    return { first, count };
  }

  removeElements(where) {
    this.change('remove_elements', where, 'elements');
  }

  elementParticles(element) {
    const { core } = this;
    return core.call(() => {
      this.call('get_element_particles', whole(element, 'element'), 0, 0, core.word);
      const count = core.data.getUint32(core.word, true), found = core.room('u32', count);
      this.call('get_element_particles', element, found, count, core.word);
      return core.copyOut('u32', found, count);
    });
  }
}
