!> A measured curve, given in a case by the name of a file with two columns of numbers. A model declares it as a parameter; the code
!> that reads cases sets the numbers.
module measured_curve
  use kinds, only: dp
  use model_parameters, only: parameter_list_t
  implicit none
  private
  public :: measured_curve_t

  type :: measured_curve_t
    character(len=:), allocatable :: file       !! path as the case gives it, relative to the case file
    character(len=:), allocatable :: digest     !! digest of the file's bytes required by the case; empty: any
    character(len=:), allocatable :: path       !! absolute path of the file that was read; not allocated: none yet
    character(len=:), allocatable :: found      !! digest of that file
    real(dp), allocatable :: x(:), y(:)         !! the columns, x increasing
    real(dp), allocatable :: z(:)               !! the third column, of a curve of vectors
  contains
    procedure :: parameters
    procedure :: is_wanted
  end type measured_curve_t

contains

  !> Declare the keys NAME and NAME_digest. The file is required if there is no default; an empty name means no file.
  subroutine parameters(self, list, name, says, default, example)
    class(measured_curve_t), intent(inout) :: self
    class(parameter_list_t), intent(inout) :: list
    character(len=*), intent(in) :: name, says
    character(len=*), intent(in), optional :: default, example
    call list%text(name, self%file, says, default, example=example, is_path=.true.)
    call list%text(name//'_digest', self%digest, &
      'digest of that file, written by resolved cases; a file with other content is refused; '''': any file', '')
  end subroutine parameters

  !> Whether the case names a file.
  pure logical function is_wanted(self)
    class(measured_curve_t), intent(in) :: self
    is_wanted = .false.
    if (allocated(self%file)) is_wanted = self%file /= ''
  end function is_wanted
end module measured_curve
