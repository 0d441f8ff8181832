!> What a shell shows of the program: completion of its command line, and its page of the manual.
module shell_pages
  use text_tools, only: replaced, next_line, joined
  use case_schema, only: key_table_t, case_schema_of, group_names
  use command_line, only: options, help_text, subjects, shells, progress_words, languages
  use accuracy_presets, only: accuracy_levels
  use case_templates, only: template_kinds
  use version_number, only: program_version
  implicit none
  private
  public :: completion_text, manual_text

  character(len=*), parameter :: n = achar(10)

contains

  !> The completion script of a shell: options, values of options, and GROUP.KEY= with its words behind --set.
  function completion_text(shell) result(text)
    character(len=*), intent(in) :: shell   !! one of `shells`
    character(len=:), allocatable :: text
    select case (shell)
    case ('bash')
      text = bash_text()
    case ('zsh')
      text = '#compdef gudgeon'//n//'autoload -U +X bashcompinit && bashcompinit'//n//bash_text()
    case default
      text = fish_text()
    end select
  end function completion_text

  function bash_text() result(text)
    character(len=:), allocatable :: text
    text = '_gudgeon() {'//n// &
      '  local now="${COMP_WORDS[COMP_CWORD]}" before="${COMP_WORDS[COMP_CWORD-1]}" line="${COMP_LINE:0:COMP_POINT}"'//n// &
      '  now="${line##*[[:space:]]}"; local cut=""'//n// &
      '  case "$now" in *=*) cut="${now%%=*}=" ;; esac'//n// &
      '  [ "$before" = "=" ] && before="${COMP_WORDS[COMP_CWORD-3]}"'//n// &
      '  [ "$now" = "$cut" ] && before="${COMP_WORDS[COMP_CWORD-2]}"'//n// &
      '  local words=""'//n// &
      '  case "$before" in'//n// &
      '    -s|--set) words="'//settings()//'"; compopt -o nospace ;;'//n// &
      '    -a|--accuracy) words="'//listed(accuracy_levels)//'" ;;'//n// &
      '    --progress) words="'//listed(progress_words)//'" ;;'//n// &
      '    --language) words="'//listed(languages)//'" ;;'//n// &
      '    --reference) words="'//all_subjects()//'" ;;'//n// &
      '    --completion) words="'//listed(shells)//'" ;;'//n// &
      '    -o|--out|--from) COMPREPLY=($(compgen -f -- "$now")); compopt -o filenames; return ;;'//n// &
      '    *) case "$now" in'//n// &
      '      --template=*) words="'//'--template='//replaced(template_kinds, ', ', ' --template=')//'" ;;'//n// &
      '      -*) words="'//all_options()//'" ;;'//n// &
      '      *) COMPREPLY=($(compgen -W "sweep plot" -- "$now") $(compgen -d -- "$now") $(compgen -f -X "!*.nml" -- "$now"))'//n// &
      '         compopt -o filenames; return ;;'//n// &
      '    esac ;;'//n// &
      '  esac'//n// &
      '  COMPREPLY=($(compgen -W "$words" -- "$now"))'//n// &
      '  [ -n "$cut" ] && COMPREPLY=("${COMPREPLY[@]#"$cut"}")'//n// &
      '}'//n//'complete -F _gudgeon gudgeon'//n
  end function bash_text

  function fish_text() result(text)
    character(len=:), allocatable :: text, line
    integer :: i
    text = 'complete -c gudgeon -f -a "sweep plot" -n __fish_is_first_token'//n// &
      'complete -c gudgeon -k -a "(__fish_complete_suffix .nml)"'//n
    do i = 1, size(options)
      line = 'complete -c gudgeon -l '//trim(options(i)%long)
      if (options(i)%short /= '') line = line//' -s '//options(i)%short
      select case (options(i)%long)
      case ('set')
        line = line//' -x -a "'//settings()//'"'
      case ('accuracy')
        line = line//' -x -a "'//listed(accuracy_levels)//'"'
      case ('progress')
        line = line//' -x -a "'//listed(progress_words)//'"'
      case ('language')
        line = line//' -x -a "'//listed(languages)//'"'
      case ('reference')
        line = line//' -x -a "'//all_subjects()//'"'
      case ('completion')
        line = line//' -x -a "'//listed(shells)//'"'
      case default
        if (options(i)%takes_value) line = line//' -r'
      end select
      text = text//line//n
    end do
  end function fish_text

  !> Words with blanks between them, of a list with commas.
  function listed(words) result(text)
    character(len=*), intent(in) :: words
    character(len=:), allocatable :: text
    text = replaced(words, ',', '')
  end function listed

  !> All options with two hyphens.
  function all_options() result(text)
    character(len=:), allocatable :: text
    integer :: i
    text = ''
    do i = 1, size(options)
      text = text//' --'//trim(options(i)%long)
    end do
    text = text(2:)
  end function all_options

  !> GROUP.KEY= for each key; GROUP.KEY=WORD where it has words.
  function settings() result(text)
    character(len=:), allocatable :: text, key
    type(key_table_t) :: table
    integer :: i
    call case_schema_of(table)
    text = ''
    do i = 1, size(table%keys)
      key = trim(table%keys(i)%group)//'.'//trim(table%keys(i)%name)//'='
      if (allocated(table%keys(i)%words)) then
        text = text//' '//key//replaced(table%keys(i)%words, ', ', ' '//key)
      else
        text = text//' '//key
      end if
    end do
    text = text(2:)
  end function settings

  !> The subjects of --reference, with the groups of cases.
  function all_subjects() result(text)
    character(len=:), allocatable :: text
    type(key_table_t) :: table
    call case_schema_of(table)
    text = listed(subjects//' '//joined(group_names(table%groups)))
  end function all_subjects

  !> The page of the manual, in the language of man: the text of --help in its sections.
  function manual_text() result(text)
    character(len=:), allocatable :: text, help, line
    integer :: at, number
    logical :: in_options
    help = help_text()
    text = '.TH GUDGEON 1 "" "gudgeon '//program_version//'" "User Commands"'//n//'.SH NAME'//n// &
      'gudgeon \- dynamics of the slider\-crank mechanism with clearance in its joints'//n//'.SH SYNOPSIS'//n
    at = 1
    number = 0
    in_options = .false.
    do while (at <= len(help))
      call next_line(help, at, line)
      number = number + 1
      if (number == 4) text = text//'.SH DESCRIPTION'//n
      if (line == '') cycle
      if (index(line, '  ') == 1 .and. verify(line, ' ') < 10) then
        if (.not. in_options) text = text//'.SH OPTIONS'//n
        in_options = .true.
        text = text//'.TP'//n//'.B '//roff(trim(adjustl(line(:28))))//n//roff(line(29:))//n
      else if (index(line, ' ') == 1) then
        text = text//roff(trim(adjustl(line)))//n
      else
        if (index(line, 'Results of CASE') == 1) text = text//'.SH FILES'//n
        if (index(line, 'Exit status') == 1) text = text//'.SH EXIT STATUS'//n
        text = text//roff(line)//n
        if (number < 3) text = text//'.br'//n
      end if
    end do
    text = text//'.SH ENVIRONMENT'//n//'.B XDG_CACHE_HOME'//n//'is the folder that keeps tables of films; ~/.cache without it.'//n
  end function manual_text

  !> A line whose hyphens and backslashes mean themselves.
  function roff(text) result(line)
    character(len=*), intent(in) :: text
    character(len=:), allocatable :: line
    line = replaced(replaced(text, '\', '\e'), '-', '\-')
    if (scan(line, '.''') == 1) line = '\&'//line
  end function roff
end module shell_pages
