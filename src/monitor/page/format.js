// Formatting of values, and creation of elements. Text is always inserted as text, never as markup.

export const $ = (selector, from = document) => from.querySelector(selector);

/// Creates an element with properties and children; strings become text nodes.
export function make(tag, properties, ...children) {
  const element = Object.assign(document.createElement(tag), properties);
  element.append(...children);
  return element;
}
export const plural = (count, word) => `${count} ${word}${count === 1 ? '' : 's'}`;
export const mm = (meters) => (meters == null ? '?' : (1e3 * meters).toFixed(1));
export const humanize = (word) => word.replaceAll('_', ' ');
export const clock = (ms) => new Date(ms).toLocaleTimeString([], { hour: '2-digit', minute: '2-digit', second: '2-digit', hour12: false });
export const dayAndClock = (ms) => (Math.abs(Date.now() - ms) < 43200000 ? clock(ms) : new Date(ms).toLocaleString([], { dateStyle: 'short', timeStyle: 'short' }));
export const simulated = (seconds) => `${Math.floor(seconds / 60)}:${String(Math.floor(seconds % 60)).padStart(2, '0')}`;
