// Language: the choice of the page's language, each named in itself, so that who reads none of the others finds the own one.
// In: the language spoken. Out: another one, kept in this browser; the page is loaded anew with it. What was typed into fields that keep their text stays.
import { chooseLanguage, language, languages, t, type Language } from '../language';

export function LanguageChoice() {
  const name = t('Language');
  return (
    <label class="select language-choice">
      {/* For those who do not read the language that is spoken now. */}
      <span class="visually-hidden">{name === 'Language' ? name : `${name} · Language`}</span>
      <select data-field="language" value={language()} onChange={(e) => chooseLanguage(e.currentTarget.value as Language)}>
        {Object.entries(languages).map(([code, own]) => (
          <option key={code} value={code} lang={code}>
            {own}
          </option>
        ))}
      </select>
    </label>
  );
}
