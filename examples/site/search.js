// Finds words in the text of the guides, and names of the reference. siteIndex, which pages.mjs has written, is a list of
// [heading, page, words of the section, title of the page]; it comes when the field is first used.
'use strict';
(() => {
  const MOST = 12, BEFORE = 40, AFTER = 80;
  const script = document.currentScript.src, root = new URL('.', script);
  let asked;

  function index() {
    asked ??= new Promise((done, failed) => {
      const element = document.createElement('script');
      element.src = new URL('search_index.js', root);
      element.onload = () => done(globalThis.siteIndex);
      element.onerror = failed;
      document.head.append(element);
    });
    return asked;
  }

  // Headings that begin with the words come first, then headings that have them, then texts; among these, short ones first.
  function rank([heading, , text = ''], words) {
    const title = heading.toLowerCase(), body = text.toLowerCase();
    const inTitle = (word) => title.includes(word);
    if (words.every(inTitle)) return (title.startsWith(words[0]) ? 0 : 1000) + title.length;
    if (!words.every((word) => inTitle(word) || body.includes(word))) return Infinity;
    const phrase = body.includes(words.join(' ')) ? 0 : 4000;
    return 2000 + phrase + (words.some(inTitle) ? 0 : 2000) + Math.min(1900, body.indexOf(words.find((word) => !inTitle(word))));
  }

  // The words around the first hit, with the hit marked.
  function excerpt(text, words) {
    const line = document.createElement('small'), low = text.toLowerCase();
    const word = words.find((one) => low.includes(one));
    if (!word) return line;
    const at = low.indexOf(words.join(' ')) >= 0 ? low.indexOf(words.join(' ')) : low.indexOf(word);
    const begin = Math.max(0, text.lastIndexOf(' ', Math.max(0, at - BEFORE)) + 1), mark = document.createElement('mark');
    mark.textContent = text.slice(at, at + (low.startsWith(words.join(' '), at) ? words.join(' ') : word).length);
    line.append(begin ? '… ' : '', text.slice(begin, at), mark, `${text.slice(at + mark.textContent.length, at + AFTER)} …`);
    return line;
  }

  function row([heading, page, text = '', title = ''], words) {
    const line = document.createElement('li'), link = document.createElement('a'), where = document.createElement('b');
    link.href = new URL(page, root);
    where.textContent = heading;
    link.append(where);
    if (title && title !== heading) link.append(` · ${title}`);
    if (!words.every((word) => heading.toLowerCase().includes(word))) link.append(excerpt(text, words));
    line.append(link);
    return line;
  }

  function nothing(asked) {
    const line = document.createElement('li'), word = document.createElement('em');
    word.textContent = asked;
    const link = (name, page) => Object.assign(document.createElement('a'), { textContent: name, href: new URL(page, root) });
    line.className = 'nothing';
    line.append('Nothing for ', word, '. Try ', link('Troubleshooting', 'examples/guides/troubleshooting.html'), ' or the ',
      link('Glossary', 'examples/guides/glossary.html'), '.');
    return line;
  }

  for (const field of document.querySelectorAll('[data-search]')) {
    const list = document.createElement('ul');
    list.className = 'found';
    list.hidden = true;
    list.setAttribute('aria-live', 'polite');
    field.after(list);
    field.addEventListener('focus', () => index().catch(() => {}), { once: true });
    field.addEventListener('input', async () => {
      const asked = field.value.trim(), words = asked.toLowerCase().split(/\s+/).filter(Boolean), entries = await index();
      if (field.value.trim() !== asked) return;
      const found = entries.map((entry) => ({ entry, at: words.length ? rank(entry, words) : Infinity }))
        .filter(({ at }) => at < Infinity).sort((a, b) => a.at - b.at).slice(0, MOST);
      list.replaceChildren(...found.map(({ entry }) => row(entry, words)));
      if (!found.length && words.length) list.append(nothing(asked));
      list.hidden = !words.length;
    });
    field.addEventListener('keydown', (event) => {
      if (event.key === 'Enter') list.querySelector('a')?.click();
      if (event.key === 'Escape') list.hidden = true;
    });
  }
})();
